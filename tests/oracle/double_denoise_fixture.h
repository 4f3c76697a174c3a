// Shared by the tests of the denoisers' oracles.
#pragma once

#include <algorithm>
#include <cmath>

#include "tests/oracle/double_frame.h"
#include "tests/oracle/synthetic/synthetic_frames.h"

namespace limpid::test {

inline constexpr uint32_t width = 160, height = 90;

inline double largest(const dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

inline bool isFloor(const denoise::HostFrame& frame, size_t p) {
    return frame.ids[2 * p] == SyntheticScene::Floor;
}

/// True if all of the (2 r + 1)^2 pixels around p are in the picture and `accept` returns true for them.
template <typename Accept>
bool allAround(size_t p, int r, const Accept& accept) {
    const int x = static_cast<int>(p % width), y = static_cast<int>(p / width);
    for (int j = y - r; j <= y + r; ++j) {
        for (int i = x - r; i <= x + r; ++i) {
            if (i < 0 || j < 0 || i >= int{width} || j >= int{height}) return false;
            if (!accept(static_cast<size_t>(j) * width + static_cast<size_t>(i))) return false;
        }
    }
    return true;
}

/// A plane that fills the picture and faces the viewer: distance 2 everywhere, grey, without motion.
inline denoise::HostFrame frontalPlane(uint32_t columns, uint32_t rows) {
    denoise::HostFrame frame;
    frame.width = columns;
    frame.height = rows;
    frame.camera.forward = {0, 0, -1};
    frame.camera.right = {1, 0, 0};
    frame.camera.up = {0, 1, 0};
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        for (auto* layer : {&frame.diffuse, &frame.specular, &frame.emission})
            layer->insert(layer->end(), {0, 0, 0, 0});
        for (auto* layer : {&frame.normal, &frame.previousNormal}) layer->insert(layer->end(), {0, 0, 1, 0});
        frame.albedo.insert(frame.albedo.end(), {0.5f, 0.5f, 0.5f, 0});
        frame.depth.insert(frame.depth.end(), {2, 1, 0, 0});
        frame.motion.insert(frame.motion.end(), {0, 0, 0, 1});
        frame.ids.insert(frame.ids.end(), {0, 0});
    }
    return frame;
}

}  // namespace limpid::test
