#include "lab/quality/measure_sequence.h"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "base/error.h"
#include "cli/options/render_options.h"
#include "lab/quality/bench_quality.h"
#include "lab/quality/report/quality_page.h"
#include "renderer/long/render_identity.h"
#include "scene/framing/camera_path.h"
#include "scene/motion/movement.h"

namespace limpid::cli {
namespace {

/// A sequence loaded onto the device.
struct LoadedSequence {
    scene::Scene scene;
    scene::SceneData data;
    std::unique_ptr<scene::GpuScene> gpu;
    std::optional<scene::CameraPath> path;
    SequenceTiming timing;

    Sequence frames() const { return {scene, data, scene.cameras.front(), path, timing}; }
};

/// Thrown for sequences that --quick skips.
struct TooLarge : Error {
    using Error::Error;
};

LoadedSequence load(gpu::Device& device, const QualityOptions& o, const QualitySequence& sequence) {
    LoadedSequence loaded;
    loaded.scene = scene::openScene({.scene = sequence.scene, .environment = sequence.environment});
    const uint64_t triangles = loaded.scene.triangleCount();
    if (o.quick && triangles >= quick::maxTriangles) {
        throw TooLarge(
            fmt::format("has {} triangles, and --quick takes less than {}", triangles, quick::maxTriangles));
    }
    if (!loaded.scene.rig.clips.empty()) scene::chooseClip(loaded.scene, "");
    if (scene::isBuiltinCameraPath(sequence.cameraPath)) {
        loaded.path =
            scene::builtinCameraPath(sequence.cameraPath, loaded.scene, loaded.scene.cameras.front(),
                                     loaded.timing.timeOf(sequence.frames.count));
    } else if (sequence.cameraPath != "none") {
        loaded.path = scene::loadCameraPath(sequence.cameraPath);
    }
    loaded.data = scene::buildSceneData(loaded.scene);
    loaded.gpu = std::make_unique<scene::GpuScene>(device, loaded.data,
                                                   scene::TraceOptions{chosenTracer(o.device, device), {}});
    return loaded;
}

MeasuredSequence measure(gpu::Device& device, const QualityOptions& o,
                         const std::vector<QualityMethod>& methods, const QualitySequence& sequence,
                         LoadedSequence& loaded) {
    const Sequence frames = loaded.frames();
    ReferenceFiles files{.folder = o.referenceFolder, .sequence = sequence.name};
    if (!files.folder.empty()) files.sceneHash = sceneHash(loaded.scene, loaded.data);
    RenderSettings exact = methods.front().settings;
    exact.jitter = o.aliased ? Jitter::Off : Jitter::Pixel;
    const std::vector<Reference> references =
        makeReferences(device, *loaded.gpu, frames, exact, sequence.frames, sequence.referenceSamples, files);
    return {sequence, loaded.scene.triangleCount(),
            measureQuality(device, *loaded.gpu, frames, methods, sequence.frames, references, o.samples,
                           !o.report.empty())};
}

}  // namespace

QualityOutcome measureSequence(gpu::Device& device, const QualityOptions& o,
                               const std::vector<QualityMethod>& methods, const QualitySequence& sequence,
                               uint64_t pictureBytes) {
    std::optional<LoadedSequence> loaded;
    try {
        loaded = load(device, o, sequence);
    } catch (const TooLarge& error) {
        return SkippedSequence{sequence.name, error.what()};
    } catch (const Error& error) {
        if (!sequence.optional) throw;
        return SkippedSequence{sequence.name, error.what()};
    }
    MeasuredSequence measured = measure(device, o, methods, sequence, *loaded);
    keepWithin(measured.quality, pictureBytes);
    return measured;
}

}  // namespace limpid::cli
