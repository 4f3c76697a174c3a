// The encodings of an embedding program's normals. The including shader declares `IngestParams params` beforehand.

/// Decodes octahedral coordinates, -1 to 1: Z. H. Cigolle et al., "A Survey of Efficient Representations for
/// Independent Unit Vectors", JCGT 2014.
vec3 fromOctahedral(vec2 e) {
    const vec3 v = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    const vec2 folded = (1.0 - abs(v.yx)) * vec2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0);
    return normalize(vec3(v.z < 0.0 ? folded : v.xy, v.z));
}

vec3 worldNormal(vec4 texel) {
    vec3 n = texel.xyz;
    if (params.normalEncoding == NORMAL_UNORM) n = 2.0 * n - 1.0;
    if (params.normalEncoding == NORMAL_OCTAHEDRAL_SIGNED) n = fromOctahedral(n.xy);
    if (params.normalEncoding == NORMAL_OCTAHEDRAL_UNORM) n = fromOctahedral(2.0 * n.xy - 1.0);
    if (params.normalInView != 0u) n = n.x * params.viewX + n.y * params.viewY + n.z * params.viewZ;
    // Already unit vectors keep their bits.
    return abs(dot(n, n) - 1.0) < 2e-3 ? n : unitNormal(vec4(n, 0.0));
}
