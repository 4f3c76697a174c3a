// For tests: a small render whose blocks consist of random numbers.
#pragma once

#include <random>

#include "renderer/long/sums/accumulation_file.h"

namespace limpid::test {

inline const std::vector<std::string> allLayers(layerNames());

inline AccumulationHeader smallHeader() {
    AccumulationHeader header;
    header.identity = {{"the scene", "cornell"}, {"seed", "0"}};
    header.extent = {3, 2};
    header.plan = {.samples = 40, .blockSamples = 16, .launchSamples = 1};  // three blocks, the last of 8
    header.device = "device";
    header.driver = "driver";
    header.tracer = "compute";
    return header;
}

/// Returns random means of `layer` in a block, from -2 to 2, the fourth not negative. Equal arguments give
/// equal means.
inline std::vector<float> randomMeans(const LayerInfo& layer, uint32_t block, uint64_t pixels) {
    std::seed_seq seed(layer.name.begin(), layer.name.end());
    std::mt19937 random(seed);
    random.discard(block * 1000);
    std::uniform_real_distribution<float> value(-2.0f, 2.0f);
    std::vector<float> means(pixels * 4);
    for (size_t i = 0; i < means.size(); ++i) means[i] = i % 4 == 3 ? std::abs(value(random)) : value(random);
    return means;
}

inline void addRandomBlock(FrameSums& sums, uint32_t block) {
    sums.addBlock(block, [&](const LayerInfo& layer) { return randomMeans(layer, block, sums.pixels()); });
    if (block == 0 && sums.wantsIds) sums.ids.assign(sums.pixels() * 2, 7);
    sums.counts.rays += 100 + block;
}

inline FrameSums randomSums(const AccumulationHeader& header, const std::vector<uint32_t>& blocks) {
    FrameSums sums(header.extent, header.plan, header.layers);
    for (const uint32_t block : blocks) addRandomBlock(sums, block);
    return sums;
}

inline void expectSame(const FrameSums& a, const FrameSums& b) {
    EXPECT_EQ(a.blocks, b.blocks);
    EXPECT_EQ(a.ids, b.ids);
    EXPECT_EQ(a.counts.rays, b.counts.rays);
    ASSERT_EQ(a.layers.size(), b.layers.size());
    for (size_t i = 0; i < a.layers.size(); ++i) {
        EXPECT_EQ(a.layers[i].info, b.layers[i].info);
        EXPECT_TRUE(a.layers[i].values == b.layers[i].values) << a.layers[i].info->name;
    }
}

}  // namespace limpid::test
