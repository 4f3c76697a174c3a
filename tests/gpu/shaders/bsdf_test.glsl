// A material and a viewer given by parameters, for shaders that test the BSDF.
#include "shaders/material/bsdf.glsl"

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
    vec3 specularColor;
    float transmission;
    float clearcoat, clearcoatRoughness;
    vec3 clearcoatNormal;
    uint thin, front;
    uint count, perThread, seed;
    float anisotropy;
    vec3 anisotropyDirection;
    vec3 sheenColor;
    float sheenRoughness;
    vec3 diffuseTransmissionColor;
    float diffuseTransmission;
    float iridescence, iridescenceIor, iridescenceThickness;
} params;

Bsdf testBsdf() {
    // Values that are not set below come from the scene's default material.
    Surface s = loadSurface(0u, NONE, vec2(0.25), params.toViewer, RayCone(0.0, false, false));
    s.geometricNormal = params.geometricNormal;
    s.normal = params.normal;
    s.front = params.front != 0u;
    s.baseColor = params.baseColor;
    s.metallic = params.metallic;
    s.roughness = params.roughness;
    s.specular = params.specular;
    s.specularColor = params.specularColor;
    s.ior = params.ior;
    s.transmission = params.transmission;
    s.thin = params.thin != 0u;
    s.clearcoat = params.clearcoat;
    s.clearcoatRoughness = params.clearcoatRoughness;
    s.clearcoatNormal = params.clearcoatNormal;
    s.anisotropy = params.anisotropy;
    s.anisotropyDirection = params.anisotropyDirection;
    s.sheenColor = params.sheenColor;
    s.sheenRoughness = params.sheenRoughness;
    s.diffuseTransmission = params.diffuseTransmission;
    s.diffuseTransmissionColor = params.diffuseTransmissionColor;
    s.iridescence = params.iridescence;
    s.iridescenceIor = params.iridescenceIor;
    s.iridescenceThickness = params.iridescenceThickness;
    return makeBsdf(s, params.toViewer);
}
