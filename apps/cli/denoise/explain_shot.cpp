#include "cli/denoise/explain_shot.h"

#include <fmt/format.h>

#include <algorithm>

#include "shot/explain.h"
#include "shot/motion/motion_search.h"
#include "shot/motion_check.h"

namespace limpid::cli {
namespace {

using shot::LoadedFrame;

LoadedFrame load(const ShotJob& job, int frame) {
    shot::LoadOptions options = job.load;
    options.layersOnly = true;
    options.network = false;
    LoadedFrame loaded = shot::loadFrame(job.input.format(std::max(frame, 0)), frame, options);
    shot::unpack(loaded, options);
    return loaded;
}

shot::FrameReport viewOf(shot::FrameConverter& converter, const LoadedFrame& frame, size_t picture,
                         const ShotJob& job, bool continues) {
    const shot::ShotLayers& layers = frame.layers[picture];
    std::optional<CameraParams> given;
    const auto camera = job.options.cameras
                            ? job.options.cameras->at(frame.number, frame.maps[picture].encoding.worldUp)
                            : std::nullopt;
    if (camera) given = camera->params(layers.width, layers.height);
    converter.convert(layers, given, continues);
    return converter.report();
}

}  // namespace

void explainShot(const ShotJob& job) {
    const LoadedFrame first = load(job, job.frames.front());
    std::optional<LoadedFrame> second;
    if (job.frames.size() > 1) second = load(job, job.frames[1]);
    fmt::print("{}", shot::explainLayers(first));
    for (size_t i = 0; i < first.maps.size(); ++i) {
        if (first.maps.size() > 1) fmt::print("{}", shot::pictureLine(first.maps[i]));
        shot::FrameConverter converter(first.maps[i]);
        shot::FrameReport report = viewOf(converter, first, i, job, false);
        const bool pair = second && i < second->maps.size();
        const bool searched = pair && first.maps[i].searchesMotion && second->maps[i].searchesMotion;
        if (searched) {
            shot::MotionSearch search;
            search.next(first.layers[i], false);
            if (auto motion = search.next(second->layers[i], true))
                second->layers[i].images["motion"] = std::move(*motion);
        }
        if (pair) report = viewOf(converter, *second, i, job, true);
        fmt::print("{}", shot::explainView(report));
        if (!pair) continue;
        const auto check = shot::checkMotion(first.layers[i], second->layers[i], first.maps[i].encoding);
        if (check) fmt::print("{}", shot::explainMotion(*check, first.number, second->number, searched));
    }
}

}  // namespace limpid::cli
