#version 460
#extension GL_EXT_scalar_block_layout : require
// Applies morph targets, then the skin, to one deforming instance: computes the vertices of this frame and of
// the previous one. glTF 2.0, sections 3.7.2.2 and 3.7.3.
#include "shaders/common/sampling.glsl"
#include "shaders/common/scene_layout.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, scalar) uniform Params {
    PoseParams params;
};
layout(set = 0, binding = 1, rgba32ui) uniform readonly uimageBuffer restVertices;
layout(set = 0, binding = 2, rgba32f) uniform readonly imageBuffer morphDeltas;
layout(set = 0, binding = 3, rgba32f) uniform readonly imageBuffer poseMatrices;
layout(set = 0, binding = 4, rgba32f) uniform writeonly imageBuffer posedVertices;
layout(set = 0, binding = 5, rgba32ui) uniform uimageBuffer vertices;
layout(set = 0, binding = 6, rgba32ui) uniform writeonly uimageBuffer previousGeometry;

struct Vertex {
    vec3 position, normal, tangent;
};

Vertex morph(Vertex v, uint vertex, uint weights) {
    for (uint t = 0u; t < params.targetCount; ++t) {
        const float weight = imageLoad(poseMatrices, int(weights + t / 4u))[t % 4u];
        const int at = int(params.morphFirst + (t * params.vertexCount + vertex) * MORPH_DELTA_TEXELS);
        v.position += weight * imageLoad(morphDeltas, at).xyz;
        v.normal += weight * imageLoad(morphDeltas, at + 1).xyz;
        v.tangent += weight * imageLoad(morphDeltas, at + 2).xyz;
    }
    return v;
}

Vertex skin(Vertex v, uint matrices, uvec4 joints, vec4 weights) {
    // A vertex that no joint moves keeps its position.
    const float rest = weights == vec4(0.0) ? 1.0 : 0.0;
    vec4 row0 = vec4(rest, 0.0, 0.0, 0.0), row1 = vec4(0.0, rest, 0.0, 0.0), row2 = vec4(0.0, 0.0, rest, 0.0);
    for (int i = 0; i < 4; ++i) {
        const int at = int(matrices + joints[i] * POSE_MATRIX_TEXELS);
        row0 += weights[i] * imageLoad(poseMatrices, at);
        row1 += weights[i] * imageLoad(poseMatrices, at + 1);
        row2 += weights[i] * imageLoad(poseMatrices, at + 2);
    }
    const vec4 p = vec4(v.position, 1.0);
    v.position = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
    const vec3 a = row0.xyz, b = row1.xyz, c = row2.xyz;
    // Cofactors: the inverse transpose except for the determinant.
    v.normal = vec3(dot(cross(b, c), v.normal), dot(cross(c, a), v.normal), dot(cross(a, b), v.normal));
    v.tangent = vec3(dot(a, v.tangent), dot(b, v.tangent), dot(c, v.tangent));
    return v;
}

Vertex pose(Vertex v, uint vertex, uint weights, uint matrices, uvec4 joints, vec4 jointWeights) {
    if (weights != NONE) v = morph(v, vertex, weights);
    if (matrices != NONE) v = skin(v, matrices, joints, jointWeights);
    return v;
}

uint packDirection(vec3 direction, vec3 otherwise) {
    const float length2 = dot(direction, direction);
    const vec3 d = length2 > 1e-30 && length2 < 1e30 ? direction : otherwise;
    return encodeOctahedral(d);
}

void main() {
    const uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= params.vertexCount) return;
    const uint number = params.firstVertex + vertex;
    const int at = int(number * REST_VERTEX_TEXELS);
    const uvec4 r0 = imageLoad(restVertices, at), r1 = imageLoad(restVertices, at + 1);
    const vec4 jointWeights = uintBitsToFloat(imageLoad(restVertices, at + 2));
    const uvec4 joints = uvec4(r1.y & 0xffffu, r1.y >> 16, r1.z & 0xffffu, r1.z >> 16);
    const Vertex rest = Vertex(uintBitsToFloat(r0.xyz), decodeOctahedral(r0.w), decodeOctahedral(r1.x));

    const Vertex now = pose(rest, vertex, params.weightsNow, params.matricesNow, joints, jointWeights);
    imageStore(posedVertices, int(number), vec4(now.position, 0.0));
    if (params.hasVertexData != 0u) {
        const int record = int(number * VERTEX_TEXELS);
        const uint tangent = (packDirection(now.tangent, vec3(1.0, 0.0, 0.0)) & ~1u) | (r1.x & 1u);
        const uvec2 uv = imageLoad(vertices, record).zw;
        imageStore(vertices, record, uvec4(packDirection(now.normal, vec3(0.0, 0.0, 1.0)), tangent, uv));
    }
    const Vertex before = pose(rest, vertex, params.weightsBefore, params.matricesBefore, joints, jointWeights);
    imageStore(previousGeometry, int(params.previousBase + number),
               uvec4(floatBitsToUint(before.position), packDirection(before.normal, vec3(0.0, 0.0, 1.0))));
}
