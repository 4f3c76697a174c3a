#include "base/layers/layer_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <utility>
#include <vector>

#include "base/layers/layer_set.h"

namespace limpid {
namespace {

/// Formats channels like docs/layers.md: "depth.Z", "R G B A".
std::string channelsOf(const LayerInfo& layer) {
    if (layer.index == varianceLayer.index) return "X.variance.V";
    std::string text = layer.index == beautyLayer.index ? "" : std::string(layer.name) + ".";
    for (const char suffix : layer.suffixes) {
        if (suffix != layer.suffixes.front()) text += ' ';
        text += suffix;
    }
    return text;
}

std::string docsRowOf(const LayerInfo& layer) {
    constexpr const char* stored[] = {"half", "float", "uint"};
    return "| `" + channelsOf(layer) + "` | " + std::string(layer.help) + " | " +
           stored[static_cast<size_t>(layer.stored)] + " |";
}

/// Returns the rows of the first table in docs/layers.md.
std::vector<std::string> rowsInDocs() {
    std::ifstream file(LIMPID_SOURCE_DIR "/docs/layers.md");
    std::vector<std::string> rows;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("| ")) rows.push_back(line);
        if (!rows.empty() && line.empty()) break;
    }
    if (!rows.empty()) rows.erase(rows.begin());  // the heading
    return rows;
}

TEST(LayerTable, IsTheTableOfTheDocs) {
    std::vector<std::string> rows;
    for (const LayerInfo& layer : layerTable) rows.push_back(docsRowOf(layer));
    EXPECT_EQ(rowsInDocs(), rows);
}

TEST(LayerTable, RowsAreComplete) {
    std::set<std::string_view> names;
    for (const LayerInfo& layer : layerTable) {
        EXPECT_TRUE(names.insert(layer.name).second) << layer.name;
        EXPECT_EQ(&layerTable.at(layer.index), &layer) << layer.name;
        EXPECT_FALSE(layer.help.empty()) << layer.name;
        EXPECT_EQ(layer.need == Need::Advised, !layer.without.empty()) << layer.name;
        EXPECT_EQ(std::set(layer.suffixes.begin(), layer.suffixes.end()).size(), layer.suffixes.size());
    }
    for (const LayerInfo& layer : frameLayers) {
        EXPECT_FALSE(layer.member.empty() || layer.suffixes.empty()) << layer.name;
        EXPECT_EQ(layer.isMean(), layer.stored != Stored::Uint) << layer.name;
        EXPECT_LE(layer.meanComponents(), 4u) << layer.name;
        // The fourth float is the variance, the share of samples, or unused.
        if (layer.varianceOf != VarianceOf::Nothing) {
            EXPECT_LE(layer.meanComponents(), 3u) << layer.name;
        }
        if (layer.varianceInFiles) {
            EXPECT_NE(layer.varianceOf, VarianceOf::Nothing) << layer.name;
        }
    }
}

TEST(LayerTable, HelpNamesTheLayersWithVariance) {
    std::string names;
    for (const LayerInfo& layer : frameLayers) {
        if (layer.varianceInFiles) names += (names.empty() ? ": " : ", ") + std::string(layer.name);
    }
    EXPECT_TRUE(varianceLayer.help.ends_with(names)) << names;
}

// Names must not change, or files of sums and EXR files become unreadable.
TEST(LayerTable, NamesInFilesStay) {
    std::vector<std::string_view> names;
    for (const LayerInfo& layer : layerTable) names.push_back(layer.name);
    EXPECT_THAT(
        names, testing::IsSupersetOf({"beauty", "diffuse", "specular", "emission", "albedo", "albedoSpecular",
                                      "normal", "prevNormal", "depth", "motion", "reflectionMotion",
                                      "roughness", "hitDistance", "id", "variance", "samples"}));
}

TEST(LayerSet, HasAMemberForEachLayer) {
    LayerSet<float, int> set;
    size_t visited = 0;
    set.forEach([&](const LayerInfo& layer, auto& member) {
        EXPECT_EQ(&layer, &frameLayers[visited++]);
        member = static_cast<std::remove_reference_t<decltype(member)>>(layer.index);
    });
    EXPECT_EQ(visited, frameLayers.size());
    for (const LayerInfo& layer : frameLayers) {
        if (layer.stored == Stored::Uint) {
            EXPECT_THROW(set[layer], std::out_of_range) << layer.name;
        } else {
            EXPECT_EQ(set[layer], static_cast<float>(layer.index)) << layer.name;
        }
    }
    EXPECT_EQ(frameLayers[static_cast<size_t>(set.previousNormal) - 1].member, "previousNormal");
    EXPECT_EQ(frameLayers[static_cast<size_t>(set.ids) - 1].name, "id");
    EXPECT_THROW(set[beautyLayer], std::out_of_range);
    EXPECT_THROW(std::as_const(set)[samplesLayer], std::out_of_range);
}

}  // namespace
}  // namespace limpid
