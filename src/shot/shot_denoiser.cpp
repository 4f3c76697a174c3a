#include "shot/shot_denoiser.h"

#include <algorithm>
#include <cmath>

#include "shot/estimate/reflection_motion.h"
#include "shot/estimate/variance_estimate.h"
#include "shot/frame/pixel_layers.h"
#include "shot/motion/motion_search.h"
#include "shot/recover/recovery.h"

namespace limpid::shot {
namespace {

using denoise::HostFrame;

/// Other renderers' samples lie all over the pixel, so with few of them edges differ from frame to frame like
/// a jittered picture's. This many frames are averaged with fewer samples than `smoothSamples`; with more,
/// the blur of moving textures outweighs the noise. Chosen on the shots `camera` and `objects` of
/// scripts/shots.
constexpr float framesOfEdges = 2.0f;
constexpr uint32_t smoothSamples = 8;
/// On transparent film, where coverage is noisy, so many samples are averaged; chosen on the shot `hair`.
constexpr float samplesOfCoverage = 16.0f;

/// Where a surface has hardly any diffuse light, networks are shown the albedo of its other light: of metal,
/// or of what mirrors and glass show.
void showSpecularAlbedo(HostFrame& frame) {
    for (size_t p = 0; 4 * p < frame.albedoSpecular.size(); ++p) {
        const float *specular = &frame.albedoSpecular[4 * p], *diffuse = &frame.albedo[4 * p];
        if (diffuse[0] + diffuse[1] + diffuse[2] < 0.05f * (specular[0] + specular[1] + specular[2]))
            std::copy_n(specular, 3, &frame.albedo[4 * p]);
    }
}

/// Each frame is downloaded before the next one, so a second one would only take memory.
const gpu::GraphOptions oneFrame{.framesInFlight = 1};

/// True if two frames' pictures have the same layers.
bool isAlike(const LayerMap& a, const LayerMap& b) {
    const auto sameText = [](const LayerExpression& x, const LayerExpression& y) {
        return x.text() == y.text();
    };
    return a.prefix == b.prefix && a.view == b.view &&
           std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                      [&](const auto& x, const auto& y) {
                          return x.first == y.first && sameText(x.second, y.second);
                      }) &&
           std::equal(a.groups.begin(), a.groups.end(), b.groups.begin(), b.groups.end(), sameText);
}

/// How many frames anti-aliasing averages. It would mix covered and empty pixels of transparent film.
/// Networks take each frame by itself.
float edgeFrames(const ShotLayers& layers, const denoise::Denoiser& method) {
    const bool few = layers.samples > 0 && layers.samples < smoothSamples;
    return few && !layers.isTransparent && !method.network ? framesOfEdges : 1.0f;
}

/// SVGF, for which recovery was made, and what goes on from it.
bool filtersBySvgf(const denoise::Denoiser& method) {
    return std::ranges::find(method.groups, "svgf") != method.groups.end();
}

/// Where light was divided by it: where a surface is seen.
void multiplyByAlpha(const image::Image& alpha, const HostFrame& frame, CleanPicture& picture) {
    const auto multiply = [&](std::vector<float>& colors) {
        for (size_t i = 0; i < colors.size(); ++i)
            if (i % 4 != 3 && frame.depth[i / 4 * 4 + 1] > 0.0f) colors[i] *= alpha.pixels[i / 4];
    };
    multiply(picture.beauty);
    for (std::vector<float>& group : picture.groups) multiply(group);
}

/// Motion that leads to `other` gets the differences of distances.
void addDistances(HostFrame& frame, const std::optional<HostFrame>& other) {
    if (!other || other->width != frame.width || other->height != frame.height) return;
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        if (!(frame.motion[4 * p + 3] > 0.0f)) continue;
        const float x = std::floor(static_cast<float>(p % frame.width) + frame.motion[4 * p] + 0.5f);
        const float y = std::floor(static_cast<float>(p / frame.width) + frame.motion[4 * p + 1] + 0.5f);
        if (!(x >= 0.0f && y >= 0.0f && x < static_cast<float>(frame.width) &&
              y < static_cast<float>(frame.height)))
            continue;
        const size_t q = static_cast<size_t>(y) * frame.width + static_cast<size_t>(x);
        frame.motion[4 * p + 2] = distanceOf(*other, q) - distanceOf(frame, p);
    }
}

}  // namespace

struct ShotDenoiser::Picture {
    explicit Picture(const LayerMap& of) : map(of), converter(of) {}
    LayerMap map;
    FrameConverter converter;
    MotionSearch search;  ///< for files without motion
    gpu::FrameGraph graph{oneFrame};
    gpu::FrameGraph coveredColors{oneFrame}, coverage{oneFrame};  ///< of transparent film
    bool wasCovered = false;  ///< the frame before has left a history in them
    std::vector<std::unique_ptr<gpu::FrameGraph>> groups;
    Recovery recovery;
    std::optional<HostFrame> last;  ///< of Backwards: the guides of the frame after
    bool lastIsSearched = false;    ///< its motion leads to the frame after it, so it cannot be inverted
};

ShotDenoiser::ShotDenoiser(gpu::Device& device, const ShotOptions& options, Direction direction)
    : device_(device), options_(options), direction_(direction) {}
ShotDenoiser::~ShotDenoiser() = default;

gpu::FrameGraph& ShotDenoiser::graph(size_t picture) {
    return pictures_.at(picture)->graph;
}

HostFrame ShotDenoiser::hostFrame(LoadedFrame& frame, size_t index, Picture& picture, bool continues) {
    if (frame.own) return std::move(*frame.own);
    ShotLayers& layers = frame.layers[index];
    std::optional<CameraParams> given;
    const auto camera =
        options_.cameras ? options_.cameras->at(frame.number, picture.map.encoding.worldUp) : std::nullopt;
    if (camera) given = camera->params(layers.width, layers.height, frame.file.pixelAspect());
    if (frame.maps[index].searchesMotion)
        if (auto motion = picture.search.next(layers, continues))
            layers.images["motion"] = std::move(*motion);
    return picture.converter.convertUsingUp(layers, given, continues, direction_ == Direction::Backwards);
}

CleanPicture ShotDenoiser::clean(gpu::FrameGraph& graph, const HostFrame& frame, float frames,
                                 bool continues) {
    CleanPicture result;
    denoise::DenoiserSettings settings = options_.settings;
    if (frame.specular.empty()) settings.svgf.separate = false;
    if (!options_.keepsAntialiasing) settings.taa.frames = frames;
    if (!continues) graph.resetHistories();
    graph.beginFrame();
    denoise::DenoiserInput input = denoise::uploadBorrowed(graph, frame);
    input.choose(gpu::filterChoice(device_));
    const denoise::DenoiserOutput clean = options_.method->record(graph, input, settings, options_.networks);
    graph.execute(device_);
    result.beauty = graph.downloadFloat(device_, clean.beauty);
    if (clean.frames) {
        const std::vector<float> texels = graph.downloadFloat(device_, clean.frames);
        for (size_t p = 3; p < texels.size(); p += 4) result.frames.push_back(texels[p]);
    }
    if (clean.disocclusion)
        result.disocclusion = denoise::countDisocclusion(graph.downloadUint(device_, clean.disocclusion));
    return result;
}

/// Averages colours (RGBA) over frames as temporal anti-aliasing does.
std::vector<float> ShotDenoiser::smoothed(gpu::FrameGraph& graph, const HostFrame& frame,
                                          std::vector<float> colors, float frames, bool continues) {
    if (!continues) graph.resetHistories();
    graph.beginFrame();
    const gpu::Extent extent{frame.width, frame.height};
    denoise::DenoiserInput input;
    input.choose(gpu::filterChoice(device_));
    const auto upload = [&](const char* name, const std::vector<float>& texels) {
        const gpu::ImageHandle image = graph.transient(name, gpu::Format::RGBA32Float, extent);
        graph.uploadBorrowed(image, gpu::bytesOf(texels));
        return image;
    };
    for (float& value : colors) value = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
    input.depth = upload("input/depth", frame.depth);
    input.motion = upload("input/motion", frame.motion);
    const gpu::ImageHandle result =
        denoise::antialias(graph, input, upload("input/colors", colors), {.frames = frames});
    graph.execute(device_);
    return graph.downloadFloat(device_, result);
}

/// Multiplies the clean picture by alpha, and averages both over frames in the same way: with few samples,
/// most of the noise of thin things is their coverage. Alpha that cannot be written (that of --file) stays.
void ShotDenoiser::coverFilm(Picture& picture, const LoadedFrame& file, size_t index, const HostFrame& frame,
                             bool continues, CleanPicture& result) {
    const ShotLayers& layers = file.layers[index];
    const image::Image& alpha = layers.images.at("alpha");
    multiplyByAlpha(alpha, frame, result);
    const auto samples = static_cast<float>(layers.samples);
    const float framesOfCoverage =
        samples > 0.0f ? std::max(samplesOfCoverage / std::max(samples, 2.0f), 1.0f) : 1.0f;
    const bool alone = options_.keepsAntialiasing || options_.method->network ||
                       !isReplaceable(file.file, *file.maps[index].find("alpha"));
    if (alone || framesOfCoverage <= 1.0f) return;
    result.beauty =
        smoothed(picture.coveredColors, frame, std::move(result.beauty), framesOfCoverage, continues);
    std::vector<float> shares(4 * alpha.pixels.size());
    for (size_t i = 0; i < shares.size(); ++i) shares[i] = alpha.pixels[i / 4];
    shares = smoothed(picture.coverage, frame, std::move(shares), framesOfCoverage, continues);
    for (size_t p = 0; p < alpha.pixels.size(); ++p) result.alpha.push_back(std::min(shares[4 * p], 1.0f));
}

/// Limpid's own files give what a renderer that denoises its frames shows.
bool ShotDenoiser::recovers(const LoadedFrame& frame, size_t index) const {
    if (frame.own || options_.recover == Recover::Off) return false;
    return options_.recover == Recover::On ||
           (frame.maps[index].hasIndependentPixels && filtersBySvgf(*options_.method));
}

/// Each group is one signal with the frame's guides. Its light takes the place of the frame's, since a copy
/// would take much memory.
void ShotDenoiser::cleanGroups(Picture& picture, const LoadedFrame& file, size_t index, HostFrame& one,
                               bool continues, CleanPicture& result) {
    const ShotLayers& layers = file.layers[index];
    for (size_t i = 0; i < one.albedoSpecular.size(); ++i) one.albedo[i] += one.albedoSpecular[i];
    one.specular.clear();
    one.albedoSpecular.clear();
    one.roughness.clear();
    image::Image rest = layers.images.at("beauty");
    for (size_t g = 0; g <= layers.groups.size(); ++g) {
        const image::Image& light = g < layers.groups.size() ? layers.groups[g] : rest;
        for (size_t p = 0; p < one.pixelCount(); ++p) {
            const bool hit = one.depth[4 * p + 1] > 0.0f;
            const float alpha = layers.isTransparent && hit ? layers.images.at("alpha").pixels[p] : 1.0f;
            for (size_t c = 0; c < 3; ++c) {
                const float value = light.pixels[3 * p + c];
                one.diffuse[4 * p + c] = hit ? value / alpha : 0.0f;
                one.emission[4 * p + c] = hit ? 0.0f : value;
                if (g < layers.groups.size()) rest.pixels[3 * p + c] -= value;
            }
        }
        if (!file.estimated.empty()) estimateVariances(one, file.estimated);
        if (g == picture.groups.size()) picture.groups.push_back(std::make_unique<gpu::FrameGraph>(oneFrame));
        result.groups.push_back(
            clean(*picture.groups[g], one, edgeFrames(layers, *options_.method), continues).beauty);
    }
}

/// Lets the frame's motion lead to the frame after, which was denoised before it.
void ShotDenoiser::goBackwards(HostFrame& host, Picture& picture, bool continues, bool own, bool searched) {
    HostFrame guides;  // before the motion is inverted: the next call needs this frame's
    guides.width = host.width;
    guides.height = host.height;
    guides.motion = host.motion;
    guides.depth = host.depth;
    guides.camera = host.camera;
    // That of other renderers' files leads to the frame after already, which was converted before.
    std::vector<float> reflectionMotion;
    if (!own) reflectionMotion.swap(host.reflectionMotion);
    if (searched && !own) {
        addDistances(host, picture.last);  // it leads to the frame after already
    } else if (continues && picture.last && !picture.lastIsSearched) {
        turnAround(host, *picture.last);
        host.reflectionMotion.swap(reflectionMotion);
        dropMovingMirrors(picture.last->camera, host);
    } else {
        std::fill(host.motion.begin(), host.motion.end(), 0.0f);
    }
    picture.last = std::move(guides);
    picture.lastIsSearched = searched && !own;
}

std::vector<CleanPicture> ShotDenoiser::denoise(LoadedFrame& frame, bool continues) {
    std::vector<CleanPicture> results;
    const size_t count = frame.own ? 1 : frame.maps.size();  // other layers of Limpid's files are no pictures
    for (size_t i = 0; i < count; ++i) {
        if (i == pictures_.size()) pictures_.push_back(std::make_unique<Picture>(frame.maps[i]));
        // A file with other pictures or layers begins a new history.
        if (!isAlike(pictures_[i]->map, frame.maps[i]))
            pictures_[i] = std::make_unique<Picture>(frame.maps[i]);
        Picture& picture = *pictures_[i];
        const bool own = frame.own.has_value();
        HostFrame host = hostFrame(frame, i, picture, continues);
        if (options_.method->network && !own) showSpecularAlbedo(host);
        if (!frame.estimated.empty()) estimateVariances(host, frame.estimated);
        if (direction_ == Direction::Backwards)
            goBackwards(host, picture, continues, own,
                        frame.maps[i].searchesMotion || picture.converter.report().motionSearched);
        CleanPicture& result = results.emplace_back(clean(
            picture.graph, host, own ? 0.0f : edgeFrames(frame.layers[i], *options_.method), continues));
        result.report = picture.converter.report();
        if (!own && direction_ == Direction::Forwards && !frame.layers[i].groups.empty())
            cleanGroups(picture, frame, i, host, continues, result);
        const bool covers = !own && frame.layers[i].isTransparent;
        if (covers) coverFilm(picture, frame, i, host, continues && picture.wasCovered, result);
        picture.wasCovered = covers;
        if (recovers(frame, i))
            picture.recovery.apply(result.beauty, frame.layers[i].images.at("beauty"), host,
                                   frame.layers[i].samples, continues);
        if (!own) frame.layers[i] = {};
    }
    return results;
}

void turnAround(HostFrame& now, const HostFrame& next) {
    const size_t count = now.pixelCount();
    std::vector<float> nearest(count, INFINITY);
    std::fill(now.motion.begin(), now.motion.end(), 0.0f);
    now.reflectionMotion.clear();
    now.previousNormal = now.normal;
    if (next.pixelCount() != count || next.width != now.width) return;
    for (size_t q = 0; q < count; ++q) {
        const float share = next.motion[4 * q + 3], distance = distanceOf(next, q);
        if (!(share > 0.0f && distance > 0.0f)) continue;
        const vec2 moved(next.motion[4 * q] / share, next.motion[4 * q + 1] / share);
        const float before = distance + next.motion[4 * q + 2] / share;
        const float x = std::floor(static_cast<float>(q % now.width) + moved.x + 0.5f);
        const float y = std::floor(static_cast<float>(q / now.width) + moved.y + 0.5f);
        if (!(x >= 0.0f && y >= 0.0f && x < static_cast<float>(now.width) &&
              y < static_cast<float>(now.height)))
            continue;
        const size_t p = static_cast<size_t>(y) * now.width + static_cast<size_t>(x);
        // A pixel that shows another surface now is hidden in the next frame, or the other one.
        if (!(before < nearest[p]) || std::abs(before - distanceOf(now, p)) > 0.1f * before) continue;
        nearest[p] = before;
        const float texel[] = {-moved.x, -moved.y, distance - distanceOf(now, p), 1.0f};
        std::copy_n(texel, 4, &now.motion[4 * p]);
    }
}

}  // namespace limpid::shot
