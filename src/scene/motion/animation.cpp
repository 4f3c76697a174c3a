#include "scene/motion/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <utility>

namespace limpid::scene {
namespace {

glm::quat toQuat(const float* xyzw) {
    return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]};
}

void storeUnit(const glm::quat& q, std::vector<float>& result) {
    const float length = glm::length(q);
    // A quaternion of zeros is no rotation.
    const glm::quat unit =
        length > 1e-20f && std::isfinite(length) ? q / length : glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
    result = {unit.x, unit.y, unit.z, unit.w};
}

/// Cubic Hermite (glTF 2.0, appendix C.4): `key` points at in-tangent, value, out-tangent.
float hermite(const float* key, const float* next, size_t component, size_t components, float t,
              float seconds) {
    const float t2 = t * t, t3 = t2 * t;
    const float value0 = key[components + component], value1 = next[components + component];
    const float out0 = key[2 * components + component], in1 = next[component];
    return (2 * t3 - 3 * t2 + 1) * value0 + seconds * (t3 - 2 * t2 + t) * out0 + (3 * t2 - 2 * t3) * value1 +
           seconds * (t3 - t2) * in1;
}

void apply(const Channel& channel, double time, Node& node) {
    std::vector<float> v;
    channel.evaluate(time, v);
    switch (channel.value) {
        case AnimatedValue::Translation:
            node.translation = {v[0], v[1], v[2]};
            break;
        case AnimatedValue::Rotation:
            node.rotation = toQuat(v.data());
            break;
        case AnimatedValue::Scale:
            node.scale = {v[0], v[1], v[2]};
            break;
        case AnimatedValue::Weights:
            node.weights = std::move(v);
            break;
    }
}

}  // namespace

mat4 Node::local() const {
    if (matrix) return *matrix;
    return glm::scale(glm::translate(mat4(1.0f), translation) * glm::mat4_cast(rotation), scale);
}

void Channel::evaluate(double time, std::vector<float>& result) const {
    const bool cubic = interpolation == Interpolation::CubicSpline;
    const size_t stride = cubic ? size_t{3} * components : components;
    const auto after = std::upper_bound(times.begin(), times.end(), time);
    const size_t next = std::min(static_cast<size_t>(after - times.begin()), times.size() - 1);
    const size_t key = after == times.begin() ? 0 : static_cast<size_t>(after - times.begin()) - 1;
    const float* a = &values[key * stride];
    const float* b = &values[next * stride];
    const float* valueA = cubic ? a + components : a;
    result.assign(valueA, valueA + components);
    const bool between = next > key && interpolation != Interpolation::Step;
    const float seconds = between ? times[next] - times[key] : 1.0f;
    const auto t = between ? static_cast<float>((time - times[key]) / seconds) : 0.0f;
    if (between && cubic) {
        for (size_t c = 0; c < components; ++c) result[c] = hermite(a, b, c, components, t, seconds);
    } else if (between && value != AnimatedValue::Rotation) {
        for (size_t c = 0; c < components; ++c) result[c] = a[c] + t * (b[c] - a[c]);
    }
    if (value != AnimatedValue::Rotation) return;
    if (between && !cubic) {
        storeUnit(glm::slerp(toQuat(a), toQuat(b), t), result);
    } else {
        storeUnit(toQuat(result.data()), result);
    }
}

float Clip::duration() const {
    float last = 0.0f;
    for (const Channel& channel : channels) last = std::max(last, channel.times.back());
    return last;
}

RigPose evaluate(const Rig& rig, const Clip* clip, double time) {
    std::vector<Node> nodes = rig.nodes;
    if (clip) {
        for (const Channel& channel : clip->channels)
            apply(channel, time, nodes[static_cast<size_t>(channel.node)]);
    }
    RigPose pose;
    pose.toWorld.resize(nodes.size());
    pose.weights.resize(nodes.size());
    for (const int index : rig.order) {
        const auto i = static_cast<size_t>(index);
        const int parent = nodes[i].parent;
        const mat4 local = nodes[i].local();
        pose.toWorld[i] = parent < 0 ? local : pose.toWorld[static_cast<size_t>(parent)] * local;
        pose.weights[i] = std::move(nodes[i].weights);
    }
    return pose;
}

std::vector<mat4> jointMatrices(const Skin& skin, const RigPose& pose) {
    std::vector<mat4> matrices;
    matrices.reserve(skin.joints.size());
    for (size_t j = 0; j < skin.joints.size(); ++j) {
        matrices.push_back(pose.toWorld[static_cast<size_t>(skin.joints[j])] * skin.inverseBind[j]);
    }
    return matrices;
}

ClipsTogether playTogether(const Rig& rig) {
    ClipsTogether result;
    result.clip.name = "all";
    result.clip.together = true;
    std::map<std::pair<int, AnimatedValue>, size_t> places;
    for (const Clip& clip : rig.clips) {
        for (const Channel& channel : clip.channels) {
            const auto [place, isNew] =
                places.try_emplace({channel.node, channel.value}, result.clip.channels.size());
            if (isNew) {
                result.clip.channels.push_back(channel);
            } else {
                result.clip.channels[place->second] = channel;
                ++result.overridden;
            }
        }
    }
    return result;
}

std::vector<bool> movedNodes(const Rig& rig, const Clip& clip) {
    std::vector<bool> moved(rig.nodes.size(), false);
    for (const Channel& channel : clip.channels) {
        if (channel.value != AnimatedValue::Weights) moved[static_cast<size_t>(channel.node)] = true;
    }
    for (const int index : rig.order) {
        const auto i = static_cast<size_t>(index);
        const int parent = rig.nodes[i].parent;
        if (parent >= 0 && moved[static_cast<size_t>(parent)]) moved[i] = true;
    }
    return moved;
}

}  // namespace limpid::scene
