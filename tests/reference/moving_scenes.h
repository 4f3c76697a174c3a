// Moving scenes for tests.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "scene/prepare/prepare.h"
#include "tests/gpu/trace/trace_fixture.h"

namespace limpid::test {

/// A tube of two bones with a bulge as morph target, under a rotating node: skin and morph target together.
inline scene::Scene tubeScene() {
    scene::Scene scene = plainScene();
    scene.name = "tube";
    scene::Mesh mesh;
    scene::Deformation d;
    d.targets.resize(1);
    constexpr uint32_t rings = 24, sides = 32;
    for (uint32_t r = 0; r <= rings; ++r) {
        const float y = 2.0f * static_cast<float>(r) / rings;
        for (uint32_t s = 0; s < sides; ++s) {
            const float a = 2.0f * pi * static_cast<float>(s) / sides;
            const vec3 n(std::cos(a), 0.0f, std::sin(a));
            d.positions.push_back(0.4f * n + vec3(0, y, 0));
            d.normals.push_back(n);
            d.targets[0].positions.push_back(0.3f * std::sin(0.5f * pi * y) * n);
            d.targets[0].normals.push_back({0.1f, 0.0f, 0.0f});
            const float upper = std::clamp(y - 0.5f, 0.0f, 1.0f);
            d.joints.push_back({0, 1, 0, 0});
            d.weights.push_back({1.0f - upper, upper, 0.0f, 0.0f});
            if (r == rings) continue;
            const uint32_t i = r * sides + s, j = r * sides + (s + 1) % sides;
            mesh.indices.insert(mesh.indices.end(), {i, i + sides, j, j, i + sides, j + sides});
        }
    }
    mesh.positions = d.positions;
    mesh.normals = d.normals;
    mesh.deformation = std::make_shared<const scene::Deformation>(d);
    scene.meshes.push_back(mesh);
    using scene::AnimatedValue, scene::Interpolation;
    scene.rig.nodes.resize(4);  // root, lower bone, upper bone, the mesh's own
    scene.rig.nodes[1].parent = 0;
    scene.rig.nodes[2].parent = 1;
    scene.rig.nodes[2].translation = {0, 1, 0};
    scene.rig.nodes[3].weights = {0.0f};
    scene.rig.order = {0, 1, 2, 3};
    scene::Skin skin{{1, 2}, {mat4(1.0f), mat4(1.0f)}};
    skin.inverseBind[1][3] = vec4(0, -1, 0, 1);
    scene.rig.skins = {skin};
    const float h = std::sqrt(0.5f);
    scene.rig.clips = {
        {"bend",
         {{0, AnimatedValue::Rotation, Interpolation::Linear, 4, {0, 1}, {0, 0, 0, 1, 0, h, 0, h}},
          {2, AnimatedValue::Rotation, Interpolation::Linear, 4, {0, 1}, {0, 0, 0, 1, 0, 0, h, h}},
          {2, AnimatedValue::Scale, Interpolation::Linear, 3, {0, 1}, {1, 1, 1, 1, 1.2f, 0.8f}},
          {3, AnimatedValue::Weights, Interpolation::Step, 1, {0, 0.45f}, {0.2f, 0.9f}},
          {0,
           AnimatedValue::Translation,
           Interpolation::CubicSpline,
           3,
           {0, 1},
           {0, 0, 0, 0, 0, 0, 0.5f, 0, 0, 0.5f, 0, 0, 0.3f, 0.2f, 0, 0, 0, 0}}}}};
    addInstance(scene, 0);
    scene.instances[0].node = 3;
    scene.instances[0].skin = 0;
    scene::prepare(scene);
    return scene;
}

}  // namespace limpid::test
