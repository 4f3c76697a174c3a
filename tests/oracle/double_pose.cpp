#include "tests/oracle/double_pose.h"

#include <algorithm>
#include <cmath>

namespace limpid::test {
namespace {

using scene::AnimatedValue;
using scene::Channel;
using scene::Interpolation;

using Numbers = std::vector<double>;

Numbers keyValue(const Channel& c, size_t key, size_t part) {
    const bool cubic = c.interpolation == Interpolation::CubicSpline;
    const size_t at = (cubic ? 3 * key + part : key) * c.components;
    return {c.values.begin() + static_cast<std::ptrdiff_t>(at),
            c.values.begin() + static_cast<std::ptrdiff_t>(at + c.components)};
}

Numbers normalised(Numbers q) {
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (double& v : q) v /= length;
    return q;
}

Numbers slerp(const Numbers& a, Numbers b, double t) {
    double cosine = 0.0;
    for (int i = 0; i < 4; ++i) cosine += a[i] * b[i];
    if (cosine < 0.0) {
        for (double& v : b) v = -v;
        cosine = -cosine;
    }
    const double angle = std::acos(std::min(cosine, 1.0));
    Numbers result(4);
    for (int i = 0; i < 4; ++i) {
        result[i] = angle < 1e-9
                        ? a[i] + t * (b[i] - a[i])
                        : (std::sin((1 - t) * angle) * a[i] + std::sin(t * angle) * b[i]) / std::sin(angle);
    }
    return normalised(result);
}

Numbers valueAt(const Channel& c, double time) {
    const size_t middle = c.interpolation == Interpolation::CubicSpline ? 1 : 0;
    const bool rotation = c.value == AnimatedValue::Rotation;
    const auto at = [&](size_t key) {
        const Numbers v = keyValue(c, key, middle);
        return rotation ? normalised(v) : v;
    };
    size_t k = 0;
    while (k + 1 < c.times.size() && double{c.times[k + 1]} <= time) ++k;
    if (time <= double{c.times[0]}) return at(0);
    if (k + 1 == c.times.size() || c.interpolation == Interpolation::Step) return at(k);
    const double span = double{c.times[k + 1]} - c.times[k];
    const double t = (time - c.times[k]) / span;
    if (c.interpolation == Interpolation::Linear) {
        if (rotation) return slerp(at(k), at(k + 1), t);
        Numbers a = at(k);
        const Numbers b = at(k + 1);
        for (size_t i = 0; i < a.size(); ++i) a[i] = (1 - t) * a[i] + t * b[i];
        return a;
    }
    const Numbers v0 = keyValue(c, k, 1), out0 = keyValue(c, k, 2), in1 = keyValue(c, k + 1, 0),
                  v1 = keyValue(c, k + 1, 1);
    Numbers result(c.components);
    for (size_t i = 0; i < result.size(); ++i) {
        result[i] = (2 * t * t * t - 3 * t * t + 1) * v0[i] + span * (t * t * t - 2 * t * t + t) * out0[i] +
                    (-2 * t * t * t + 3 * t * t) * v1[i] + span * (t * t * t - t * t) * in1[i];
    }
    return rotation ? normalised(result) : result;
}

dmat4 rotation(const Numbers& q) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    dmat4 m(1.0);
    m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
    m[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
    m[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
    return m;
}

}  // namespace

DoublePose::DoublePose(const scene::Scene& scene, double time) : scene_(scene) {
    const auto& nodes = scene.rig.nodes;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const scene::Node& n = nodes[i];
        Numbers t{n.translation.x, n.translation.y, n.translation.z};
        Numbers r{n.rotation.x, n.rotation.y, n.rotation.z, n.rotation.w};
        Numbers s{n.scale.x, n.scale.y, n.scale.z};
        Numbers w(n.weights.begin(), n.weights.end());
        for (const Channel& c : scene.rig.clips[static_cast<size_t>(scene.clip)].channels) {
            if (c.node != static_cast<int>(i)) continue;
            if (c.value == AnimatedValue::Translation) t = valueAt(c, time);
            if (c.value == AnimatedValue::Rotation) r = valueAt(c, time);
            if (c.value == AnimatedValue::Scale) s = valueAt(c, time);
            if (c.value == AnimatedValue::Weights) w = valueAt(c, time);
        }
        dmat4 scaling(1.0), translation(1.0);
        for (int k = 0; k < 3; ++k) {
            scaling[k][k] = s[static_cast<size_t>(k)];
            translation[3][k] = t[static_cast<size_t>(k)];
        }
        locals_.push_back(n.matrix ? dmat4(*n.matrix) : translation * rotation(r) * scaling);
        weights_.push_back(std::move(w));
    }
}

dmat4 DoublePose::nodeToWorld(int node) const {
    dmat4 m(1.0);
    for (; node >= 0; node = scene_.rig.nodes[static_cast<size_t>(node)].parent)
        m = locals_[static_cast<size_t>(node)] * m;
    return m;
}

DoublePose::Vertex DoublePose::vertex(uint32_t index, uint32_t v) const {
    const scene::Instance& instance = scene_.instances[index];
    const scene::Mesh& mesh = scene_.meshes[static_cast<size_t>(instance.mesh)];
    const bool deforming = instance.movement == scene::Movement::Deforming;
    Vertex out{dvec3(mesh.positions[v]), mesh.normals.empty() ? dvec3(0.0) : dvec3(mesh.normals[v])};
    dmat4 toWorld = instance.node < 0 || instance.movement == scene::Movement::Still
                        ? dmat4(instance.transform)
                        : nodeToWorld(instance.node);
    if (deforming) {
        const scene::Deformation& d = *mesh.deformation;
        out.position = dvec3(d.positions[v]);
        if (!d.normals.empty()) out.normal = dvec3(d.normals[v]);
        const Numbers& w = weights_[static_cast<size_t>(instance.node)];
        for (size_t t = 0; t < d.targets.size() && t < w.size(); ++t) {
            if (!d.targets[t].positions.empty()) out.position += w[t] * dvec3(d.targets[t].positions[v]);
            if (!d.targets[t].normals.empty()) out.normal += w[t] * dvec3(d.targets[t].normals[v]);
        }
        if (instance.skin >= 0) {
            const scene::Skin& skin = scene_.rig.skins[static_cast<size_t>(instance.skin)];
            toWorld = dmat4(0.0);
            for (int c = 0; c < 4; ++c) {
                const size_t joint = d.joints[v][static_cast<size_t>(c)];
                toWorld += double{d.weights[v][c]} * nodeToWorld(skin.joints[joint]) *
                           dmat4(skin.inverseBind[joint]);
            }
        }
    }
    out.position = dvec3(toWorld * dvec4(out.position, 1.0));
    out.normal = glm::transpose(glm::inverse(dmat3(toWorld))) * out.normal;
    return out;
}

dvec3 DoublePose::corner(uint32_t instance, uint32_t primitive, int k) const {
    const scene::Mesh& mesh = scene_.meshes[static_cast<size_t>(scene_.instances[instance].mesh)];
    return vertex(instance, mesh.indices[3 * primitive + static_cast<uint32_t>(k)]).position;
}

dvec3 DoublePose::point(uint32_t instance, uint32_t primitive, const dvec2& b) const {
    return (1.0 - b.x - b.y) * corner(instance, primitive, 0) + b.x * corner(instance, primitive, 1) +
           b.y * corner(instance, primitive, 2);
}

dvec3 DoublePose::normal(uint32_t instance, uint32_t primitive, const dvec2& b) const {
    const scene::Mesh& mesh = scene_.meshes[static_cast<size_t>(scene_.instances[instance].mesh)];
    if (mesh.normals.empty()) {
        const dvec3 a = corner(instance, primitive, 0);
        return glm::normalize(
            glm::cross(corner(instance, primitive, 1) - a, corner(instance, primitive, 2) - a));
    }
    const double weights[3] = {1.0 - b.x - b.y, b.x, b.y};
    dvec3 sum(0.0);
    for (uint32_t k = 0; k < 3; ++k) {
        sum += weights[k] * glm::normalize(vertex(instance, mesh.indices[3 * primitive + k]).normal);
    }
    return glm::normalize(sum);
}

}  // namespace limpid::test
