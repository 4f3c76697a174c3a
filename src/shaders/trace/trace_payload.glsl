// What a ray of the `hardware` tracer carries between its shaders.
#ifndef LIMPID_TRACE_PAYLOAD_GLSL
#define LIMPID_TRACE_PAYLOAD_GLSL

struct TracePayload {
    float t;  // negative: nothing hit
    vec2 barycentrics;
    uint triangle;  // in bvhTriangles
    uint instance;
    uint rng;  // for the alpha test
};

#endif
