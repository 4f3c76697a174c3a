#include "renderer/layers/frame_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/error.h"
#include "renderer/frame/camera_text.h"
#include "renderer/layers/layers.h"

namespace limpid::test {
namespace {

using denoise::HostFrame;
using image::LayeredImage;
using testing::HasSubstr;
using testing::Not;

/// Two pixels: one with a different value in every component, one without a value from any sample.
RenderedLayers twoPixels() {
    RenderedLayers layers;
    layers.extent = {2, 1};
    layers.samples = 5;
    for (const LayerInfo& layer : frameLayers) {
        if (!layer.isMean()) continue;
        std::vector<float>& texels = layers[layer];
        texels.assign(8, 0.0f);
        for (size_t c = 0; c < layer.suffixes.size(); ++c)
            texels[c] = static_cast<float>(layer.index) + 0.25f * static_cast<float>(c);
        if (layer.hasShare()) texels[layer.suffixes.size()] = 1.0f;
        if (layer.varianceInFiles) texels[3] = static_cast<float>(layer.index);
    }
    layers.ids = {7, 3, UINT32_MAX, UINT32_MAX};
    return layers;
}

LayeredImage fileOf(const RenderedLayers& layers) {
    LayeredImage file = toLayeredImage(layers, layerNames(), image::Storage::Float);
    CameraParams camera{};
    camera.origin = vec3(1.0f, 2.0f, 3.0f);
    file.metadata = {{cameraAttribute, cameraText(camera)}, {"limpid.samples", "5"}};
    return file;
}

void erase(LayeredImage& file, const std::string& layer) {
    std::erase_if(file.channels,
                  [&](const image::Channel& channel) { return channel.name.starts_with(layer + "."); });
}

std::vector<std::string_view> lackingIn(const LayeredImage& file, bool sequence) {
    std::vector<const LayerInfo*> lacking;
    frameOf(file, "x.exr", sequence, lacking);
    std::vector<std::string_view> names;
    for (const LayerInfo* layer : lacking) names.push_back(layer->name);
    return names;
}

std::string faultOf(const LayeredImage& file, bool sequence) {
    try {
        lackingIn(file, sequence);
    } catch (const InputError& error) {
        return error.what();
    }
    return "none";
}

void expectSame(const HostFrame& frame, const RenderedLayers& layers) {
    for (const LayerInfo& layer : frameLayers) {
        if (layer.isMean()) {
            EXPECT_EQ(frame[layer], layers[layer]) << layer.name;
        }
    }
}

TEST(FrameFile, EveryLayerComesBack) {
    const RenderedLayers layers = twoPixels();
    std::vector<const LayerInfo*> lacking;
    const HostFrame frame = frameOf(fileOf(layers), "x.exr", true, lacking);
    expectSame(frame, layers);
    EXPECT_EQ(frame.ids, (std::vector<uint32_t>{7, UINT32_MAX, UINT32_MAX, UINT32_MAX}));
    EXPECT_EQ(frame.samples, 5u);
    EXPECT_EQ(frame.camera.origin, vec3(1.0f, 2.0f, 3.0f));
    EXPECT_TRUE(lacking.empty());
}

TEST(FrameFile, TheJitterIsAnAttribute) {
    LayeredImage file = fileOf(twoPixels());
    std::vector<const LayerInfo*> lacking;
    EXPECT_EQ(frameOf(file, "x.exr", false, lacking).jitter, std::nullopt);
    const vec2 jitter(0.1f, -0.5f);
    file.metadata[jitterAttribute] = jitterText(jitter);
    EXPECT_EQ(frameOf(file, "x.exr", false, lacking).jitter, jitter);
    for (const char* text : {"", "0.1", "0.1 0.2 0.3", "0.6 0", "nan 0", "0,1 0"}) {
        file.metadata[jitterAttribute] = text;
        EXPECT_EQ(faultOf(file, false),
                  std::string("x.exr: 'limpid.jitter' is no point of a pixel: ") + text);
    }
}

TEST(FrameFile, AReaderMayHaveTheValues) {
    const RenderedLayers layers = twoPixels();
    const LayeredImage full = fileOf(layers);
    LayeredImage names = full;
    for (image::Channel& channel : names.channels) channel.values.clear();
    const ChannelReader reader = [&](const std::string& channel, std::span<float> to, size_t stride) {
        for (size_t p = 0; p < 2; ++p) to[stride * p] = full.find(channel)->values[p];
    };
    std::vector<const LayerInfo*> lacking;
    const HostFrame frame = frameOf(names, "x.exr", true, lacking, reader);
    expectSame(frame, layers);
    EXPECT_EQ(frame.ids, (std::vector<uint32_t>{7, UINT32_MAX, UINT32_MAX, UINT32_MAX}));
}

TEST(FrameFile, SharesAreDividedOut) {
    RenderedLayers layers = twoPixels();
    layers.depth[0] = 3.0f;
    layers.depth[1] = 0.5f;
    const LayeredImage file = fileOf(layers);
    EXPECT_EQ(file.get("depth", "Z").pixels, (std::vector<float>{6.0f, 1e10f}));
    EXPECT_EQ(file.get("motion", "XYZ").pixels[3], 1e10f);
    std::vector<const LayerInfo*> lacking;
    const HostFrame frame = frameOf(file, "x.exr", false, lacking);
    EXPECT_EQ(frame.depth[0], 6.0f);
    EXPECT_EQ(frame.depth[1], 1.0f);
}

TEST(FrameFile, LayersThatWereNotComputedAreNotWritten) {
    RenderedLayers layers = twoPixels();
    layers.specular.clear();
    layers.ids.clear();
    const LayeredImage file = fileOf(layers);
    EXPECT_EQ(file.find("specular.R"), nullptr);
    EXPECT_EQ(file.find("specular.variance.V"), nullptr);
    EXPECT_EQ(file.find("id.I"), nullptr);
    EXPECT_NE(file.find("diffuse.variance.V"), nullptr);
}

TEST(FrameFile, VarianceIsReadUnderBothNames) {
    const RenderedLayers layers = twoPixels();
    LayeredImage file = fileOf(layers);
    for (image::Channel& channel : file.channels) {
        if (channel.name.ends_with(".variance.V")) channel.name.resize(channel.name.size() - 2);
    }
    std::vector<const LayerInfo*> lacking;
    expectSame(frameOf(file, "x.exr", true, lacking), layers);
    EXPECT_TRUE(lackingVariances(file).empty());
}

TEST(FrameFile, WithoutAdvisedLayersNothingTurnsAndThereIsOneObject) {
    LayeredImage file = fileOf(twoPixels());
    erase(file, "prevNormal");
    erase(file, "id");
    erase(file, "reflectionMotion");
    EXPECT_EQ(lackingIn(file, true), (std::vector<std::string_view>{"prevNormal", "id"}));
    EXPECT_TRUE(lackingIn(file, false).empty());
    std::vector<const LayerInfo*> lacking;
    const HostFrame frame = frameOf(file, "x.exr", true, lacking);
    EXPECT_TRUE(std::equal(frame.normal.begin(), frame.normal.begin() + 3, frame.previousNormal.begin()));
    EXPECT_EQ(frame.ids, std::vector<uint32_t>(4, 0));
    EXPECT_EQ(frame.reflectionMotion, std::vector<float>(8, 0.0f));
}

TEST(FrameFile, MissingLayersAreNamed) {
    LayeredImage file = fileOf(twoPixels());
    for (const char* layer : {"motion", "diffuse", "normal"}) erase(file, layer);
    EXPECT_THAT(faultOf(file, true), HasSubstr("x.exr: lacks the layers diffuse, normal, motion, which"));
    EXPECT_THAT(faultOf(file, false), HasSubstr("x.exr: lacks the layers diffuse, normal, which"));
    LayeredImage means = fileOf(twoPixels());
    std::erase_if(means.channels,
                  [](const image::Channel& channel) { return channel.name.ends_with(".variance.V"); });
    std::vector<std::string_view> names;
    for (const LayerInfo* layer : lackingVariances(means)) names.push_back(layer->name);
    EXPECT_EQ(names, (std::vector<std::string_view>{"diffuse", "specular", "albedo", "normal", "depth"}));
    EXPECT_TRUE(lackingVariances(fileOf(twoPixels())).empty());
}

}  // namespace
}  // namespace limpid::test
