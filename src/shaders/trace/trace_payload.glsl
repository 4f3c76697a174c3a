// The payload of the `hardware` tracer's rays.
#ifndef LIMPID_TRACE_PAYLOAD_GLSL
#define LIMPID_TRACE_PAYLOAD_GLSL

struct TracePayload {
    float t;  // negative: no hit
    vec2 barycentrics;
    uint triangle;  // in bvhTriangles
    uint instance;
    uint rng;  // for the alpha test
};

#endif
