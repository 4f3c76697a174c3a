// Writes src/scene/device/tables/dielectric_share.inc from random walks on microfacets:
//
//     build/release/tests/limpid_dielectric_share > src/scene/device/tables/dielectric_share.inc
//
// Takes about two minutes on one core, and always gives the same numbers.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/device/tables/dielectric_table.h"
#include "tests/reference/microfacet_walk.h"

namespace {

using namespace limpid;

int shareOf(uint32_t node) {
    const uint32_t column = node % scene::share::cosines;
    const uint32_t row = node / scene::share::cosines % scene::share::roughnesses;
    const float eta = scene::share::eta(node / (scene::share::cosines * scene::share::roughnesses));
    const float cosine = scene::share::cosine(column, eta), roughness = scene::share::roughness(row);
    const float alpha = roughness * roughness;
    const test::DielectricEnergy all =
        test::dielectricEnergy(double{cosine}, double{alpha}, double{eta}, 40000, node + 1);
    const double missing = 1.0 - all.reflectedOnce - all.transmittedOnce;
    const double share = (all.reflected - all.reflectedOnce) / std::max(missing, 1e-9);
    return static_cast<int>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
}

}  // namespace

int main() {
    std::vector<int> shares(scene::share::count);
    tbb::parallel_for(0u, scene::share::count, [&](uint32_t node) { shares[node] = shareOf(node); });
    fmt::print("// Written by limpid_dielectric_share (tests/reference/dielectric_share_tool.cpp).\n");
    for (size_t i = 0; i < shares.size(); ++i)
        fmt::print("{},{}", shares[i], (i + 1) % scene::share::cosines == 0 ? "\n" : " ");
}
