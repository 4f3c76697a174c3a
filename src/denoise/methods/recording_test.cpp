// A frame's passes can be recorded and listed without Vulkan: this program does not link it.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>

#include "base/error.h"
#include "denoise/methods/film/film_network.h"
#include "denoise/methods/methods.h"
#include "denoise/methods/nano/nano_tiles.h"
#include "denoise/stages/ingest/ingest.h"
#include "denoise/stages/output/output.h"

namespace limpid::denoise {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAreArray;

constexpr gpu::Extent extent{64, 32};
constexpr gpu::ForeignImage nowhere{.image = 1, .view = 1};

using Record = DenoiserOutput (*)(gpu::FrameGraph&, const DenoiserInput&, const FilterSettings&);

/// The names of the passes of a frame of foreign images, in their order.
std::vector<std::string> passesOf(gpu::FrameGraph& graph, const FilterSettings& settings,
                                  bool reasons = false, Record record = svgf::record, bool matrices = false) {
    graph.beginFrame();
    const auto import = [&](const char* name) {
        return graph.import(name, gpu::Format::RGBA32Float, extent, nowhere);
    };
    IngestImages images;
    images.radiance = import("radiance");
    images.specular = import("specular");
    images.albedo = import("albedo");
    images.normal = import("normal");
    images.depth = import("depth");
    IngestParams params{};
    params.width = extent.width;
    params.height = extent.height;
    DenoiserInput input = ingest(graph, images, params, {.twoSignals = settings.svgf.separate});
    input.reasons.wanted = reasons;
    input.matrices = matrices;
    record(graph, input, settings);
    std::vector<std::string> names;
    for (const gpu::RecordedPass& pass : graph.passes()) names.push_back(pass.name);
    return names;
}

TEST(RecordingTest, AFrameIsListedWithoutADevice) {
    gpu::FrameGraph graph;
    FilterSettings settings;
    settings.svgf.separate = false;
    settings.svgf.levels = 2;
    EXPECT_THAT(passesOf(graph, settings),
                ElementsAre("ingest", "svgf/reproject joint", "svgf/tiles joint", "svgf/lags joint",
                            "svgf/antilag joint", "svgf/variance joint", "svgf/level 1", "svgf/young joint",
                            "svgf/level 2", "svgf/compose"));
    const gpu::RecordedPass& reproject = graph.passes().at(1);
    ASSERT_FALSE(reproject.hazards.empty());
    EXPECT_EQ(reproject.hazards[0].earlierPass, "ingest");
    EXPECT_GT(graph.imageBytes(), uint64_t{extent.width} * extent.height * 50);
}

/// They cost nothing unless they are wanted.
TEST(RecordingTest, ReasonsAreTwoMorePasses) {
    gpu::FrameGraph graph;
    std::vector<std::string> names = passesOf(graph, {});
    const uint64_t bytes = graph.imageBytes();
    EXPECT_THAT(names, Not(Contains(HasSubstr("reasons"))));
    names.insert(names.end(), {"svgf/reasons diffuse", "svgf/reasons specular"});
    EXPECT_THAT(passesOf(graph, {}, true), UnorderedElementsAreArray(names));
    constexpr uint64_t bytesOfAPixel = 8 + 4;
    EXPECT_EQ(graph.imageBytes(), bytes + 2 * bytesOfAPixel * extent.width * extent.height);
}

TEST(RecordingTest, NanoIsSvgfWithMorePassesBeforeTheLast) {
    gpu::FrameGraph graph;
    const std::vector<std::string> names = passesOf(graph, {}, false, nano::record);
    std::vector<std::string> others;
    std::ranges::copy_if(names, std::back_inserter(others),
                         [](const std::string& name) { return !name.starts_with("nano/"); });
    EXPECT_GT(names.size(), others.size() + 10);
    EXPECT_EQ(others, passesOf(graph, {}));
    EXPECT_EQ(names.back(), "svgf/compose");
}

TEST(RecordingTest, NetworksMultiplyMatricesWhereTheDeviceCan) {
    for (const auto& [record, layers] : {std::pair{Record{nano::record}, 19u}, {Record{film::record}, 21u}}) {
        for (const bool matrices : {false, true}) {
            gpu::FrameGraph graph;
            passesOf(graph, {}, false, record, matrices);
            size_t byMatrices = 0, others = 0;
            for (const gpu::RecordedPass& pass : graph.passes()) {
                byMatrices += pass.shader.find("_matrix") != std::string::npos ? 1 : 0;
                others += pass.shader.find("nano_convolve") != std::string::npos ? 1 : 0;
            }
            EXPECT_EQ(byMatrices, matrices ? layers : 0u);
            EXPECT_EQ(others, matrices ? 0u : layers);
        }
    }
}

TEST(RecordingTest, TilesCoverThePictureAndOverlap) {
    const uint32_t reach = nanoReach(filmNetwork());
    EXPECT_EQ(reach, 156u);
    EXPECT_EQ(nanoReach(nanoNetwork()), 153u);
    for (const gpu::Extent picture : {gpu::Extent{1920, 1080}, {3840, 2160}, {7, 16001}, {1399, 1000}}) {
        const std::vector<NanoTile> tiles = nanoTiles(picture, reach, (1u << 27u) / 96);
        EXPECT_GT(tiles.size(), picture.height == 16001 ? 0u : 1u);
        uint64_t covered = 0;
        for (const NanoTile& tile : tiles) {
            const uint32_t right = tile.innerX + tile.inner.width, below = tile.innerY + tile.inner.height;
            covered += uint64_t{tile.inner.width} * tile.inner.height;
            EXPECT_LE(uint64_t{tile.extent.width} * tile.extent.height, (1u << 27u) / 96);
            EXPECT_EQ((tile.x | tile.y | tile.extent.width | tile.extent.height) % 16, 0u);
            EXPECT_TRUE(tile.x == 0 || tile.x + reach <= tile.innerX);
            EXPECT_TRUE(tile.y == 0 || tile.y + reach <= tile.innerY);
            EXPECT_GE(tile.x + tile.extent.width, std::min(right + reach, picture.width));
            EXPECT_GE(tile.y + tile.extent.height, std::min(below + reach, picture.height));
            EXPECT_LE(right, picture.width);
            EXPECT_LE(below, picture.height);
        }
        EXPECT_EQ(covered, uint64_t{picture.width} * picture.height);
    }
    EXPECT_EQ(nanoTiles({3840, 2160}, reach, 3840 * 2160).size(), 1u);
    EXPECT_THAT(nanoTiles({3840, 2160}, reach, 1000), IsEmpty());
}

/// What the arrays of nano_matrix.glsl and of the shaders that include it take.
uint32_t sharedBytes(const NanoShare& share, uint32_t groups, uint32_t taps) {
    const uint32_t subgroups = share.small ? NANO_SMALL_SUBGROUPS : NANO_SUBGROUPS;
    const uint32_t pitch = 3, line = 2 * share.tiles + 1, patch = NANO_COLUMNS * pitch;
    const bool around = taps == NANO_AROUND;
    const uint32_t inputs = around ? 9 * 16 : 8 * groups;  // whose weights are there at once
    const uint32_t pixels = around ? (NANO_COLUMNS + 2) * (subgroups * share.rows + 2) * pitch : 0;
    return 16 * (inputs * line + 16 * line + pixels + subgroups * (around ? 1 : 4) * patch);
}

void expectFits(const NanoShare& share, const NanoLayer& layer, uint32_t taps) {
    ASSERT_GT(share.tiles, 0u);
    EXPECT_EQ(layer.outputs % (2 * share.tiles), 0u);
    EXPECT_EQ(layer.inputs % 2, 0u);
    const uint32_t groups = (taps == NANO_HALVE ? 4 : 1) * layer.inputs + layer.coarser;
    EXPECT_LE(sharedBytes(share, groups, taps), 48u * 1024u);
}

/// Devices with matrices have at least as much (DeviceInfo::cooperativeMatrices).
TEST(RecordingTest, MatricesFitIntoSharedMemory) {
    for (const NanoNetwork* network : {&nanoNetwork(), &filmNetwork()}) {
        for (size_t i = 0; i < NANO_LEVELS; ++i) {
            SCOPED_TRACE(network->name + ", level " + std::to_string(i));
            const NanoLevel& level = network->levels[i];
            if (i > 0) expectFits(network->shares.halve[i], level.halve, NANO_HALVE);
            for (const NanoLayer& layer : level.around)
                expectFits(network->shares.around[i], layer, NANO_AROUND);
            if (i + 1 == NANO_LEVELS) continue;
            expectFits(network->shares.around[i], level.after, NANO_AROUND);
            expectFits(network->shares.point[i], level.join, NANO_POINT);
        }
    }
}

TEST(RecordingTest, SignalsAreWrittenWhereTheyAreWanted) {
    for (const Record record : {Record{svgf::record}, Record{nano::record}, Record{film::record}}) {
        for (const bool separate : {true, false}) {
            for (const bool wanted : {true, false}) {
                gpu::FrameGraph graph;
                graph.beginFrame();
                const gpu::ImageHandle image =
                    graph.import("image", gpu::Format::RGBA32Float, extent, nowhere);
                IngestImages images{.radiance = image, .specular = image, .normal = image, .depth = image};
                IngestParams params{};
                params.width = extent.width;
                params.height = extent.height;
                FilterSettings settings;
                settings.svgf.separate = separate;
                DenoiserInput input = ingest(graph, images, params, {.twoSignals = separate});
                input.wantsSignals = wanted;
                const DenoiserOutput output = record(graph, input, settings);
                EXPECT_TRUE(output.beauty);
                EXPECT_EQ(static_cast<bool>(output.diffuse), wanted);
                EXPECT_EQ(static_cast<bool>(output.specular), wanted && separate);
            }
        }
    }
}

TEST(RecordingTest, HistoriesLiveFromFrameToFrame) {
    gpu::FrameGraph graph;
    passesOf(graph, {});
    graph.assumeExecuted();
    passesOf(graph, {});
    const auto reproject =
        std::ranges::find(graph.passes(), "svgf/reproject diffuse", &gpu::RecordedPass::name);
    ASSERT_NE(reproject, graph.passes().end());
    EXPECT_THAT(reproject->reads, Contains(HasSubstr("(previous)")));
}

TEST(RecordingTest, AnImportedImageNeedsAHandle) {
    gpu::FrameGraph graph;
    graph.beginFrame();
    EXPECT_THROW(graph.import("nothing", gpu::Format::RGBA32Float, extent, {}), Error);
}

TEST(RecordingTest, AnImageIsSampledOrStoredNotBoth) {
    gpu::FrameGraph graph;
    graph.beginFrame();
    const gpu::ImageHandle image = graph.import("image", gpu::Format::RGBA32Float, extent, nowhere);
    IngestImages images{.radiance = image, .normal = image, .depth = image};
    IngestParams params{};
    params.width = extent.width;
    params.height = extent.height;
    FilterSettings settings;
    settings.svgf.separate = false;
    const gpu::ImageHandle beauty = svgf::record(graph, ingest(graph, images, params, {}), settings).beauty;
    EXPECT_THROW(output(graph, "color", beauty, image), Error);
}

}  // namespace
}  // namespace limpid::denoise
