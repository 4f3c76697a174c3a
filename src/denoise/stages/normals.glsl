// The encodings of an embedding program's normals.
#ifndef LIMPID_NORMALS_GLSL
#define LIMPID_NORMALS_GLSL

#include "denoise/stages/guides.glsl"
#include "denoise/stages/normal_encoding.h"

vec3 worldNormal(vec4 texel, NormalEncoding encoding) {
    vec3 n = texel.xyz;
    if (encoding.kind == NORMAL_UNORM) n = 2.0 * n - 1.0;
    if (encoding.kind == NORMAL_OCTAHEDRAL_SIGNED) n = fromOctahedral(n.xy, 1.0);
    if (encoding.kind == NORMAL_OCTAHEDRAL_UNORM) n = fromOctahedral(2.0 * n.xy - 1.0, 1.0);
    if (encoding.inView != 0u) n = n.x * encoding.viewX + n.y * encoding.viewY + n.z * encoding.viewZ;
    // Already unit vectors keep their bits.
    return abs(dot(n, n) - 1.0) < 2e-3 ? n : unitNormal(vec4(n, 0.0));
}

#endif
