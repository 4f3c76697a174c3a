// The encodings of an embedding program's normals. The including shader declares `IngestParams params` beforehand.

vec3 worldNormal(vec4 texel) {
    vec3 n = texel.xyz;
    if (params.normalEncoding == NORMAL_UNORM) n = 2.0 * n - 1.0;
    if (params.normalEncoding == NORMAL_OCTAHEDRAL_SIGNED) n = fromOctahedral(n.xy, 1.0);
    if (params.normalEncoding == NORMAL_OCTAHEDRAL_UNORM) n = fromOctahedral(2.0 * n.xy - 1.0, 1.0);
    if (params.normalInView != 0u) n = n.x * params.viewX + n.y * params.viewY + n.z * params.viewZ;
    // Already unit vectors keep their bits.
    return abs(dot(n, n) - 1.0) < 2e-3 ? n : unitNormal(vec4(n, 0.0));
}
