// What a BSDF (bsdf.glsl) is made of, and what evaluating and sampling it return.
#ifndef LIMPID_BSDF_TYPE_GLSL
#define LIMPID_BSDF_TYPE_GLSL

#include "shaders/material/clearcoat.glsl"
#include "shaders/material/material.glsl"
#include "shaders/material/microfacet.glsl"
#include "shaders/material/sheen.glsl"
#include "shaders/material/thin_film.glsl"

struct Bsdf {
    mat3 frame;
    vec3 wo;
    vec3 geometricNormal;  // world space, on the viewer's side
    vec3 diffuse;          // albedo of the base below the coat
    vec3 diffuseBelow;     // the same for light that the base transmits
    vec3 f0;               // Schlick's terms of the reflecting lobe
    float f90;
    float coatF0, coatF90;  // of the dielectric coat alone
    float metal;           // weight of the metal
    vec3 metalF0;
    vec3 multiple;         // roughly the share of white light that remains after several facets of the metal
    vec3 through;          // tint and weight of the thin pane's transmitted lobe
    vec3 glass;            // tint of the refracting boundary's transmitted light
    float glassWeight;     // of the refracting boundary
    float roughGlass;      // same, but 0 if its lobes are perfectly smooth
    float alpha, roughness, eta;
    vec2 alphas;       // of the frame's x and y, with anisotropy
    float anisotropy;  // its strength
    bool smoothSurface;
    vec4 albedo;     // ggxAlbedo at wo
    vec3 average;    // ggxAverage
    float coatLoss;     // share of energy that the coat keeps from the base at wo
    float coatAverage;  // the same, of light from all directions
    vec2 glassGain;     // multiple scattering's gain of the refracting boundary's two lobes, without masking
    vec2 glassDiffuse;  // diffuse-like part of multiple scattering at the boundary: reflected and transmitted
    vec4 probability;   // of sampling the diffuse, reflecting, thin transmitting and refracting lobe
    float belowProbability;  // of sampling the diffuse-like transmission
    ThinFilm film;         // over metal and plastic
    vec3 plasticF0;        // of the dielectric without its specular factor
    vec3 filmedF0;         // mean reflectance of the metal's facets
    vec3 filmedMirror;     // reflectance of facets that face the viewer's mirrored direction
    float plainMetal, plastic;  // weights of the metal and of the dielectric below the film
    Sheen sheen;
    Clearcoat clearcoat;
};

struct BsdfValue {
    vec3 diffuse, specular;  // f cos
    float pdf;
};

struct BsdfSample {
    vec3 direction;  // world
    BsdfValue value;
    bool delta;       // only BSDF sampling can find this direction
    bool valid;
};

#endif
