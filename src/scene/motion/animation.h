// Animation of a scene: a hierarchy of nodes, skins and clips, and the pose they give at a time.
//
// Specification: glTF 2.0, sections 3.7.3 (skins) and 3.11 (animations) and appendix C (interpolation),
// https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html#animations
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"

namespace limpid::scene {

struct Node {
    std::string name;
    int parent = -1;  ///< -1: a root
    vec3 translation{0.0f};
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< unit
    vec3 scale{1.0f};
    std::optional<mat4> matrix;  ///< affine; replaces the three above. Such a node is not animated
    std::vector<float> weights;  ///< of its mesh's morph targets, at rest

    mat4 local() const;
};

struct Skin {
    std::vector<int> joints;        ///< nodes
    std::vector<mat4> inverseBind;  ///< one per joint
};

enum class Interpolation : uint8_t { Step, Linear, CubicSpline };
enum class AnimatedValue : uint8_t { Translation, Rotation, Scale, Weights };

/// The values of one property of one node over time. Constant before the first key and after the last.
struct Channel {
    int node = -1;
    AnimatedValue value = AnimatedValue::Translation;
    Interpolation interpolation = Interpolation::Linear;
    uint32_t components = 3;    ///< 3; 4 for rotations (x, y, z, w); the number of weights
    std::vector<float> times;   ///< seconds, finite, not negative, strictly increasing; at least one
    std::vector<float> values;  ///< `components` per time; CubicSpline: in-tangent, value, out-tangent

    void evaluate(double time, std::vector<float>& result) const;  ///< rotations: unit
};

struct Clip {
    std::string name;
    std::vector<Channel> channels;
    bool together = false;  ///< made by playTogether()

    float duration() const;  ///< seconds, to the last key
};

struct Rig {
    std::vector<Node> nodes;
    std::vector<int> order;  ///< all nodes, parents before their children
    std::vector<Skin> skins;
    std::vector<Clip> clips;
};

/// The pose of the whole scene at one time.
struct RigPose {
    std::vector<mat4> toWorld;                ///< of each node
    std::vector<std::vector<float>> weights;  ///< of each node
};

/// Evaluates the pose at a time; with a null `clip`, the pose at rest.
RigPose evaluate(const Rig& rig, const Clip* clip, double time);

/// Returns the matrix of each joint of the skin, from rest position to world.
std::vector<mat4> jointMatrices(const Skin& skin, const RigPose& pose);

/// All of the rig's clips combined into one, named "all". They start at the same time, and each holds its
/// last pose until the longest has ended. If several animate the same property of a node, the last one
/// counts; `overridden` is the number of properties of other clips that are ignored.
struct ClipsTogether {
    Clip clip;
    size_t overridden = 0;
};
ClipsTogether playTogether(const Rig& rig);

/// Returns which nodes the clip moves, directly or through a parent.
std::vector<bool> movedNodes(const Rig& rig, const Clip& clip);

}  // namespace limpid::scene
