// Computes the surface at a hit: geometry (surface.glsl), and material parameters after textures and vertex colours.
// Materials: glTF 2.0, section 3.9 and appendix B.
#ifndef LIMPID_MATERIAL_GLSL
#define LIMPID_MATERIAL_GLSL

#include "shaders/material/alpha_test.glsl"

/// Returns the normal map's normal in world space.
vec3 mappedNormal(vec3 normal, vec4 tangent, vec3 texel, float scale) {
    const vec3 t = tangent.xyz - normal * dot(normal, tangent.xyz);
    const float length2 = dot(t, t);
    if (length2 < 1e-12) return normal;
    const vec3 local = (texel * 2.0 - 1.0) * vec3(scale, scale, 1.0);
    const vec3 unit = t * inversesqrt(length2);
    const vec3 mapped = local.x * unit + local.y * tangent.w * cross(normal, unit) + local.z * normal;
    return dot(mapped, mapped) > 1e-12 ? normalize(mapped) : normal;
}

/// Returns the share of emission that a clear coat transmits. It uses the geometric normal, since light
/// sampling knows no other and must agree with rays that hit the light.
float emissionThroughClearcoat(float weight, float cosine) {
    return 1.0 - weight * mix(CLEARCOAT_F0, 1.0, schlickWeight(cosine));
}

vec3 objectToWorldNormal(uint instance, vec3 n) {
    const int at = int(instance * INSTANCE_TEXELS);
    const vec3 r0 = uintBitsToFloat(imageLoad(instances, at).xyz);
    const vec3 r1 = uintBitsToFloat(imageLoad(instances, at + 1).xyz);
    const vec3 r2 = uintBitsToFloat(imageLoad(instances, at + 2).xyz);
    // Cofactors: the inverse transpose except for the determinant, whose sign keeps the side.
    const vec3 result = vec3(dot(cross(r1, r2), n), dot(cross(r2, r0), n), dot(cross(r0, r1), n));
    const vec3 scaled = scaleToOne(maxAbs(result)) * result;
    return normalize(dot(r0, cross(r1, r2)) < 0.0 ? -scaled : scaled);
}

vec3 objectToWorld(uint instance, vec4 p) {
    const int at = int(instance * INSTANCE_TEXELS);
    return vec3(dot(uintBitsToFloat(imageLoad(instances, at)), p), dot(uintBitsToFloat(imageLoad(instances, at + 1)), p),
                dot(uintBitsToFloat(imageLoad(instances, at + 2)), p));
}

/// The largest number that occurs while points with coordinates up to `largest` are placed in the world. Tracers round
/// rays to an instance's own coordinates, which may be much larger than where it stands.
float magnitudeInWorld(uint instance, vec3 largest) {
    const int at = int(instance * INSTANCE_TEXELS);
    float magnitude = 0.0;
    for (int row = 0; row < 3; ++row) {
        const vec4 factors = abs(uintBitsToFloat(imageLoad(instances, at + row)));
        magnitude = max(magnitude, dot(factors, vec4(largest, 1.0)));
    }
    return magnitude;
}

/// Returns the shading normal on the viewer's side. A mapped or interpolated normal may face away from the
/// viewer, or reflect the view direction into the surface, which would be black. It is tilted just enough to
/// face the viewer and to reflect along the surface.
vec3 facingNormal(vec3 normal, vec3 geometricNormal, vec3 toViewer) {
    const float least = 0.01;
    vec3 facing = normal;
    const float cosine = dot(normal, toViewer);
    if (cosine < least) {
        const vec3 tilted = normal + (least - cosine) * toViewer;
        facing = dot(tilted, tilted) > 1e-8 ? normalize(tilted) : geometricNormal;
    }
    const vec3 mirrored = reflect(-toViewer, facing);
    const float height = dot(mirrored, geometricNormal);
    const float lowest = min(least, 0.5 * dot(geometricNormal, toViewer));
    return height >= lowest ? facing : normalize(toViewer + normalize(mirrored + (lowest - height) * geometricNormal));
}

void applySpecularTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 6);
    s.specular *= materialTexture(refs.x, data, footprint).a;
    s.specularColor *= materialTexture(refs.y, data, footprint).rgb;
}

void applyClearcoatTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 6);
    s.clearcoat *= materialTexture(refs.z, data, footprint).r;
    s.clearcoatRoughness *= materialTexture(refs.w, data, footprint).g;
}

/// Sets the direction of the greater roughness: the mesh's tangent, turned by the texture and the material's rotation.
void applyAnisotropy(inout Surface s, int material, VertexData data, Footprint footprint, vec3 normal, vec4 tangent) {
    const uvec4 record = imageLoad(materials, material + 9);
    vec2 direction = uintBitsToFloat(record.yz);
    if (HAS_TEXTURES) {
        if (record.w != NONE) {
            const vec3 texel = materialTexture(record.w, data, footprint).rgb;
            const vec2 axis = texel.rg * 2.0 - 1.0;
            const float axis2 = dot(axis, axis);
            const vec2 unit = axis2 > 1e-8 ? axis * inversesqrt(axis2) : vec2(1.0, 0.0);
            direction = vec2(direction.x * unit.x - direction.y * unit.y, direction.y * unit.x + direction.x * unit.y);
            s.anisotropy *= texel.b;
        }
    }
    const vec3 t = tangent.xyz - normal * dot(normal, tangent.xyz);
    const float length2 = dot(t, t);
    if (length2 < 1e-12) return;
    const vec3 unit = t * inversesqrt(length2);
    s.anisotropyDirection = direction.x * unit + direction.y * tangent.w * cross(normal, unit);
}

void applySheenTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 11);
    s.sheenColor *= materialTexture(refs.x, data, footprint).rgb;
    s.sheenRoughness *= materialTexture(refs.y, data, footprint).a;
}

void applyDiffuseTransmissionTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec4 refs = imageLoad(materials, material + 11);
    s.diffuseTransmission *= materialTexture(refs.z, data, footprint).a;
    s.diffuseTransmissionColor *= materialTexture(refs.w, data, footprint).rgb;
}

/// The film's thickness is between two values if a texture says where, else the greater.
void applyIridescenceTextures(inout Surface s, int material, VertexData data, Footprint footprint) {
    const uvec2 refs = imageLoad(materials, material + 14).xy;
    s.iridescence *= materialTexture(refs.x, data, footprint).r;
    const float least = uintBitsToFloat(imageLoad(materials, material + 13).z);
    s.iridescenceThickness = mix(least, s.iridescenceThickness, materialTexture(refs.y, data, footprint).g);
}

/// Reads the factors of the extensions that few scenes have.
void loadExtensions(inout Surface s, int material) {
    s.anisotropy = s.sheenRoughness = s.diffuseTransmission = s.dispersion = 0.0;
    s.iridescence = s.iridescenceIor = s.iridescenceThickness = 0.0;
    s.anisotropyDirection = s.sheenColor = s.diffuseTransmissionColor = vec3(0.0);
    if (HAS_ANISOTROPY) s.anisotropy = uintBitsToFloat(imageLoad(materials, material + 9).x);
    if (HAS_SHEEN) {
        const vec4 sheen = uintBitsToFloat(imageLoad(materials, material + 10));
        s.sheenColor = sheen.rgb;
        s.sheenRoughness = sheen.w;
    }
    if (HAS_DIFFUSE_TRANSMISSION) {
        const vec4 diffuse = uintBitsToFloat(imageLoad(materials, material + 12));
        s.diffuseTransmissionColor = diffuse.rgb;
        s.diffuseTransmission = diffuse.w;
    }
    if (HAS_IRIDESCENCE) {
        const vec4 film = uintBitsToFloat(imageLoad(materials, material + 13));
        s.iridescence = film.x;
        s.iridescenceIor = film.y;
        s.iridescenceThickness = film.w;
    }
    if (HAS_DISPERSION) s.dispersion = uintBitsToFloat(imageLoad(materials, material + 8).w);
}

/// The coat has its own normal map or none; the base's does not affect it.
vec3 clearcoatNormal(int material, VertexData data, Footprint footprint, vec3 normal, vec4 tangent) {
    const uvec4 coat = imageLoad(materials, material + 7);
    if (coat.x == NONE) return normal;
    return mappedNormal(normal, tangent, materialTexture(coat.x, data, footprint).rgb, uintBitsToFloat(coat.w));
}

/// `toViewer` is a unit vector.
Surface loadSurface(uint triangle, uint hitInstance, vec2 barycentrics, vec3 toViewer, RayCone cone) {
    Surface s;
    const int at = int(triangle * BVH_TRIANGLE_TEXELS);
    const vec4 t0 = imageLoad(bvhTriangles, at), t1 = imageLoad(bvhTriangles, at + 1), t2 = imageLoad(bvhTriangles, at + 2);
    const bool instanced = TWO_LEVEL && hitInstance != NONE;
    s.primitive = floatBitsToUint(t0.w) & ~BVH_TRIANGLE_ALPHA;
    s.instance = instanced ? hitInstance : floatBitsToUint(t1.w);
    vec3 v0 = t0.xyz, v1 = t1.xyz, v2 = t2.xyz;
    bool mirrored = false;
    s.magnitude = 0.0;
    if (TWO_LEVEL) {
        if (instanced) {
            s.magnitude = magnitudeInWorld(hitInstance, max(abs(v0), max(abs(v1), abs(v2))));
            v0 = objectToWorld(hitInstance, vec4(v0, 1.0));
            v1 = objectToWorld(hitInstance, vec4(v1, 1.0));
            v2 = objectToWorld(hitInstance, vec4(v2, 1.0));
        }
    }
    s.position = interpolate(v0, v1, v2, barycentrics);
    s.magnitude = max(s.magnitude, max(maxAbs(v0), max(maxAbs(v1), maxAbs(v2))));
    const Face face = faceBetween(v1 - v0, v2 - v0);
    s.area = 0.5 * face.doubleArea;
    vec3 windingNormal = face.normal;
    const uvec4 shading = imageLoad(triangles, int(floatBitsToUint(t2.w)));
    s.material = materialOf(shading.w, instanced ? hitInstance : NONE);
    if (HAS_MIRRORED) {
        mirrored = (imageLoad(instances, int(s.instance * INSTANCE_TEXELS) + 3).w & INSTANCE_MIRRORED) != 0u;
    }
    if (mirrored) windingNormal = -windingNormal;
    s.front = dot(windingNormal, toViewer) >= 0.0;
    s.geometricNormal = s.front ? windingNormal : -windingNormal;
    s.normal = s.geometricNormal;

    const int material = int(s.material * MATERIAL_TEXELS);
    const uvec4 m0 = imageLoad(materials, material), m1 = imageLoad(materials, material + 1);
    const uvec4 m2 = imageLoad(materials, material + 2);
    s.baseColor = uintBitsToFloat(m0.xyz);
    s.emission = uintBitsToFloat(m1.xyz);
    s.roughness = uintBitsToFloat(m1.w);
    s.metallic = uintBitsToFloat(m2.x);
    s.specular = uintBitsToFloat(m2.y);
    s.ior = uintBitsToFloat(m2.z);
    s.transmission = uintBitsToFloat(m2.w);
    s.specularColor = HAS_SPECULAR ? uintBitsToFloat(imageLoad(materials, material + 5).yzw) : vec3(1.0);
    s.thin = (m0.w & MATERIAL_THIN) != 0u;
    if (HAS_PANES) {
        // Light behind a pane can be sampled through it, too (shadow.glsl), which reads its textures at points.
        if (cone.scattered && s.thin && s.transmission > 0.0) cone.width = 0.0;
    }
    s.unlit = (m0.w & MATERIAL_UNLIT) != 0u;
    const vec2 coat = HAS_CLEARCOAT ? uintBitsToFloat(imageLoad(materials, material + 7).yz) : vec2(0.0);
    s.clearcoat = coat.x;
    s.clearcoatRoughness = coat.y;
    float coatOverEmission = coat.x;
    loadExtensions(s, material);
    s.clearcoatNormal = s.geometricNormal;
    if (HAS_VERTEX_DATA) {
        const VertexData data = loadVertexData(shading.xyz, barycentrics);
        vec3 normal = data.normal;
        vec3 tangent = data.tangent.xyz;
        const bool smoothShaded = (shading.w & TRIANGLE_SMOOTH) != 0u;
        if (TWO_LEVEL) {
            if (instanced) {
                normal = objectToWorldNormal(hitInstance, normal);
                tangent = objectToWorld(hitInstance, vec4(tangent, 0.0));
                tangent *= scaleToOne(maxAbs(tangent));
            }
        }
        normal = smoothShaded && dot(normal, normal) > 1e-12 ? normalize(normal) : windingNormal;
        vec3 coatNormal = normal;
        s.baseColor *= data.color.rgb;
        if (HAS_TEXTURES) {
            const uvec4 refs = imageLoad(materials, material + 4);
            const Footprint footprint =
                footprintOn(v1 - v0, v2 - v0, face.normal, max(face.doubleArea, 1e-37), toViewer, cone);
            const float share = cone.scattered ? 0.0 : 1.0;
            const Footprint emitting = Footprint(share * footprint.across, share * footprint.along, footprint.exact);
            s.baseColor *= materialTexture(refs.x, data, footprint).rgb;
            s.emission *= materialTexture(refs.w, data, emitting).rgb;
            const vec4 metallicRoughness = materialTexture(refs.y, data, footprint);
            s.roughness *= metallicRoughness.g;
            s.metallic *= metallicRoughness.b;
            const float handedness = data.tangent.w * (instanced && mirrored ? -1.0 : 1.0);
            if (refs.z != NONE) {
                const float scale = uintBitsToFloat(imageLoad(materials, material + 3).z);
                normal = mappedNormal(normal, vec4(tangent, handedness), materialTexture(refs.z, data, footprint).rgb, scale);
            }
            if (HAS_CLEARCOAT) {
                coatOverEmission *= materialTexture(imageLoad(materials, material + 6).z, data, emitting).r;
                applyClearcoatTextures(s, material, data, footprint);
                coatNormal = clearcoatNormal(material, data, footprint, coatNormal, vec4(tangent, handedness));
            }
            if (HAS_SPECULAR_TEXTURES) applySpecularTextures(s, material, data, footprint);
            if (HAS_TRANSMISSION) {
                s.transmission *= materialTexture(imageLoad(materials, material + 5).x, data, footprint).r;
            }
            if (HAS_IRIDESCENCE) applyIridescenceTextures(s, material, data, footprint);
            if (HAS_SHEEN) applySheenTextures(s, material, data, footprint);
            if (HAS_DIFFUSE_TRANSMISSION) applyDiffuseTransmissionTextures(s, material, data, footprint);
        }
        if (HAS_ANISOTROPY) {
            const float handedness = data.tangent.w * (instanced && mirrored ? -1.0 : 1.0);
            const Footprint footprint =
                footprintOn(v1 - v0, v2 - v0, face.normal, max(face.doubleArea, 1e-37), toViewer, cone);
            applyAnisotropy(s, material, data, footprint, normal, vec4(tangent, handedness));
        }
        s.normal = facingNormal(s.front ? normal : -normal, s.geometricNormal, toViewer);
        if (HAS_CLEARCOAT) {
            s.clearcoatNormal = facingNormal(s.front ? coatNormal : -coatNormal, s.geometricNormal, toViewer);
        }
    }
    const bool visible = s.front || (m0.w & MATERIAL_DOUBLE_SIDED) != 0u;
    s.emission = s.unlit ? s.baseColor : visible ? s.emission : vec3(0.0);
    if (HAS_CLEARCOAT) s.emission *= emissionThroughClearcoat(coatOverEmission, dot(s.geometricNormal, toViewer));
    s.culled = !visible && !transmitsLight(s);
    s.absorption = vec3(0.0);
    if (HAS_VOLUME) {
        if (isBoundary(s)) s.absorption = uintBitsToFloat(imageLoad(materials, material + 8).xyz);
    }
    s.roughness = clamp(s.roughness, 0.0, 1.0);
    s.metallic = clamp(s.metallic, 0.0, 1.0);
    return s;
}

#endif
