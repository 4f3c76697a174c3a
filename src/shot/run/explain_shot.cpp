#include "shot/run/explain_shot.h"

#include <fmt/format.h>

#include "base/error.h"
#include "shot/explain.h"
#include "shot/motion/motion_search.h"
#include "shot/motion_check.h"

namespace limpid::shot {
namespace {

LoadedFrame load(const ShotJob& job, int frame) {
    LoadOptions options = job.load;
    LoadedFrame loaded = loadFrame(inputOf(job, frame), frame, options);
    if (options.network) {  // which variances it lacks
        unpack(loaded, options);
        loaded.own.reset();
        loaded.layers.clear();
    }
    options.layersOnly = true;
    options.network = false;
    unpack(loaded, options);
    return loaded;
}

FrameReport viewOf(FrameConverter& converter, const LoadedFrame& frame, size_t picture, const ShotJob& job,
                   bool continues) {
    const ShotLayers& layers = frame.layers[picture];
    std::optional<CameraParams> given;
    const auto camera = job.options.cameras
                            ? job.options.cameras->at(frame.number, frame.maps[picture].encoding.worldUp)
                            : std::nullopt;
    if (camera) given = camera->params(layers.width, layers.height, frame.file.pixelAspect());
    converter.convert(layers, given, continues);
    return converter.report();
}

/// The frame after the first one, which tells how things move; none if there is none.
std::optional<LoadedFrame> loadNext(const ShotJob& job) {
    const size_t at = job.firstAsked, next = at + 1;
    if (next >= job.frames.size() || job.frames[next] != job.frames[at] + 1) return std::nullopt;
    try {
        return load(job, job.frames[next]);
    } catch (const InputError&) {
        if (!job.skipUnreadable && next < job.endAsked) throw;
    }
    return std::nullopt;
}

/// Searches the motion of a picture of the second frame as denoising would. Returns whether it did.
bool searchMotion(const LoadedFrame& first, LoadedFrame& second, size_t picture) {
    const LayerMap &before = first.maps[picture], &now = second.maps[picture];
    ShotLayers& layers = second.layers[picture];
    const bool isMissing = before.searchesMotion && now.searchesMotion;
    if (!isMissing && !layers.zeroMotion) return false;
    MotionSearch search;
    search.next(first.layers[picture], false);
    if (isMissing) {
        if (auto motion = search.next(layers, true)) layers.images["motion"] = std::move(*motion);
        return true;
    }
    search.replaceZero(layers, before.encoding, true);
    return layers.motionSearched;
}

/// The camera and the motion of a picture. `second`: null if there is no such frame.
std::string explainPictureView(const LoadedFrame& first, LoadedFrame* second, size_t picture,
                               const ShotJob& job) {
    FrameConverter converter(first.maps[picture]);
    FrameReport report = viewOf(converter, first, picture, job, false);
    if (!second || picture >= second->maps.size()) return explainView(report);
    const bool isSearched = searchMotion(first, *second, picture);
    report = viewOf(converter, *second, picture, job, true);
    std::string text = explainView(report);
    const auto check =
        checkMotion(first.layers[picture], second->layers[picture], first.maps[picture].encoding);
    if (check) text += explainMotion(*check, first.number, second->number, isSearched);
    return text;
}

}  // namespace

std::string explainShot(const ShotJob& job) {
    const LoadedFrame first = load(job, job.frames[job.firstAsked]);
    std::optional<LoadedFrame> second = loadNext(job);
    std::string text = explainLayers(first);
    if (const std::string variances = explainVariances(first); !variances.empty())
        text += fmt::format("    {}\n", variances);
    for (size_t i = 0; i < first.maps.size(); ++i) {
        if (first.maps.size() > 1) text += pictureLine(first.maps[i]);
        text += explainPictureView(first, second ? &*second : nullptr, i, job);
    }
    return text;
}

}  // namespace limpid::shot
