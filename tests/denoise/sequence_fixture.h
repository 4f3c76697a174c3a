// Renders moving built-in scenes on the device frame by frame, and converged references of them.
#pragma once

#include <optional>
#include <string>

#include "renderer/frame/frame_renderer.h"
#include "renderer/sequence/sequence.h"
#include "scene/motion/movement.h"
#include "scene/prepare/prepare.h"
#include "tests/gpu/render_fixture.h"

namespace limpid::test {

class SequenceTest : public RenderTest {
  protected:
    /// Prepares the scene and chooses its first clip, if it has one. `path` is a built-in camera path that
    /// lasts `pathSeconds`, or empty.
    void load(scene::Scene scene, const SequenceTiming& timing = {}, const std::string& path = {},
              double pathSeconds = 2.0) {
        scene_ = std::move(scene);
        scene::prepare(scene_);
        if (!scene_.rig.clips.empty()) scene::chooseClip(scene_, "");
        data_ = scene::buildSceneData(scene_);
        gpuScene_.emplace(device(), data_);
        const scene::Camera camera = scene_.cameras.at(0);
        std::optional<scene::CameraPath> cameraPath;
        if (!path.empty()) cameraPath = scene::builtinCameraPath(path, scene_, camera, pathSeconds);
        sequence_.emplace(scene_, data_, camera, cameraPath, timing);
    }

    /// Renders a reference of the frame with the path tracer alone, with independent noise.
    image::Image reference(uint64_t frame, RenderSettings settings, uint64_t samples) {
        settings.pipeline = {};
        settings.seed = 1000;
        settings.samplesPerLaunch = 4;
        FrameRenderer still(device(), *gpuScene_, settings, samples);
        still.render(sequence_->moment(frame, settings.extent));
        return beautyOf(still.download());
    }

    scene::Scene scene_;
    scene::SceneData data_;
    std::optional<scene::GpuScene> gpuScene_;
    std::optional<Sequence> sequence_;
};

}  // namespace limpid::test
