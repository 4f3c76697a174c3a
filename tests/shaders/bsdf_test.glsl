// A material and a viewer by parameters, for the shaders that test the scattering function.
#include "shaders/bsdf.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 20, scalar) uniform Params {
    vec3 baseColor;
    float metallic;
    vec3 toViewer;
    float roughness;
    vec3 normal;
    float specular;
    vec3 geometricNormal;
    float ior;
    float transmission;
    uint thin, front;
    uint count, perThread, seed;
} params;

Bsdf testBsdf() {
    Surface s;
    s.specularColor = vec3(1.0);
    s.position = vec3(0.0);
    s.geometricNormal = params.geometricNormal;
    s.normal = params.normal;
    s.magnitude = 1.0;
    s.front = params.front != 0u;
    s.instance = 0u;
    s.primitive = 0u;
    s.material = 0u;
    s.baseColor = params.baseColor;
    s.metallic = params.metallic;
    s.roughness = params.roughness;
    s.specular = params.specular;
    s.ior = params.ior;
    s.transmission = params.transmission;
    s.thin = params.thin != 0u;
    s.unlit = false;
    s.emission = vec3(0.0);
    s.area = 1.0;
    return makeBsdf(s, params.toViewer);
}
