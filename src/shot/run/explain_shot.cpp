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

}  // namespace

std::string explainShot(const ShotJob& job) {
    const size_t at = job.firstAsked, next = at + 1;
    const LoadedFrame first = load(job, job.frames[at]);
    std::optional<LoadedFrame> second;
    if (next < job.frames.size() && job.frames[next] == job.frames[at] + 1) {
        try {
            second = load(job, job.frames[next]);
        } catch (const InputError&) {
            if (!job.skipUnreadable && next < job.endAsked) throw;
        }
    }
    std::string text = explainLayers(first);
    if (const std::string variances = explainVariances(first); !variances.empty())
        text += fmt::format("    {}\n", variances);
    for (size_t i = 0; i < first.maps.size(); ++i) {
        if (first.maps.size() > 1) text += pictureLine(first.maps[i]);
        FrameConverter converter(first.maps[i]);
        FrameReport report = viewOf(converter, first, i, job, false);
        const bool pair = second && i < second->maps.size();
        bool searched = pair && first.maps[i].searchesMotion && second->maps[i].searchesMotion;
        if (searched) {
            MotionSearch search;
            search.next(first.layers[i], false);
            if (auto motion = search.next(second->layers[i], true))
                second->layers[i].images["motion"] = std::move(*motion);
        } else if (pair && second->layers[i].zeroMotion) {
            MotionSearch search;
            search.next(first.layers[i], false);
            search.replaceZero(second->layers[i], first.maps[i].encoding, true);
            searched = second->layers[i].motionSearched;
        }
        if (pair) report = viewOf(converter, *second, i, job, true);
        text += explainView(report);
        if (!pair) continue;
        const auto check = checkMotion(first.layers[i], second->layers[i], first.maps[i].encoding);
        if (check) text += explainMotion(*check, first.number, second->number, searched);
    }
    return text;
}

}  // namespace limpid::shot
