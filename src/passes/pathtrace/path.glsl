// What a path carries from vertex to vertex.
#ifndef LIMPID_PATHTRACE_PATH_GLSL
#define LIMPID_PATHTRACE_PATH_GLSL

#include "passes/pathtrace/pathtrace_params.h"

layout(set = 0, binding = 20, scalar) uniform Params {
    PathtraceParams params;
};

#define SOBOL_TABLE params.points
#include "shaders/material/receiver.glsl"
#include "shaders/material/shadow.glsl"

struct PathRadiance {
    vec3 emission;           // seen directly, or as a reflection in the first glass
    vec3 diffuse, specular;  // by lobe of the first surface; their sum is all scattered light
};

struct Path {
    Ray ray;
    vec3 throughput;
    vec3 diffuseShare;  // of the path's further light, per channel
    float bsdfPdf;      // of the current direction
    LightShares shares;  // at the vertex where it began: light that it hits could have been sampled from
                         // there
    bool delta;         // the direction can only be sampled by the BSDF
    float coneWidth;
    vec3 medium;  // absorption of the body around the path, per unit of length
    PathRadiance radiance;
    uint rays;
    uint primary;  // index of the vertex that the layers describe: 0, or a later one behind mirrors and glass
    uint passages;  // through glass so far, at most params.maxTransmissionDepth
    bool mirrored;  // the vertex before the primary one is a mirror
    bool further;    // what glass does not send where the layers look
    uint reflected;  // the vertex that the first glass reflects directly; 0: none
    uint panes;      // crossed since the vertex at which it got its direction
    uint blended;    // surfaces that the path might have passed, as chance decided
    float straight;  // the way from where it got its direction to the last pane or blended surface that it passed
    uint channel;   // of the colour that it carries, once it has met glass with dispersion; else ALL_CHANNELS
};

const uint ALL_CHANNELS = 3u;

#endif
