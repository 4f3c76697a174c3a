// limpid._shot: the C interface for shots of files (limpid/shot.h) for Python. limpid/_shots.py checks
// arguments and documents them.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <exception>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "c_interface.h"
#include "gil.h"
#include "limpid/shot.h"
#include "python_error.h"

namespace py = pybind11;

namespace {

using namespace limpid::python;

/// Throws Failure if a call failed. Must run on the same thread as the call, since the error text is per
/// thread.
void check(limpid_result result) {
    if (result != LIMPID_OK) throw Failure(limpid_shot_last_error(), result);
}

/// Texts as the C interface takes them. The strings must outlive it.
class TextList {
  public:
    explicit TextList(const std::vector<std::string>& texts) {
        for (const std::string& text : texts) pointers_.push_back(text.c_str());
    }
    limpid_texts texts() const { return {pointers_.data(), pointers_.size()}; }

  private:
    std::vector<const char*> pointers_;
};

/// The options as attributes of a Python object: texts, lists of texts, numbers. Texts may be set to bytes.
struct Options {
    std::string input, output, denoiser, preset, weights, mapFile, cameras, frames, shard, cuts, onError,
        exposure, recover;
    std::vector<std::string> settings, map, files;
    std::string motion;
    float strength = 1.0f, preserve = 0.0f, fps = 0.0f;
    int cameraStart = 0;
    bool bidirectional = false, resume = false;
};

/// Calls `use` with the description of the options.
template <typename Use>
void withDesc(const Options& o, const Use& use) {
    const auto text = [](const std::string& value) { return value.empty() ? nullptr : value.c_str(); };
    const TextList settings(o.settings), map(o.map), files(o.files);
    limpid_shot_desc desc{};
    desc.size = sizeof desc;
    desc.input = o.input.c_str();
    desc.output = text(o.output);
    desc.denoiser = text(o.denoiser);
    desc.preset = text(o.preset);
    desc.settings = settings.texts();
    desc.weights = text(o.weights);
    desc.map = map.texts();
    desc.map_file = text(o.mapFile);
    desc.files = files.texts();
    desc.cameras = text(o.cameras);
    desc.fps = o.fps;
    desc.camera_start = o.cameraStart;
    desc.motion = text(o.motion);
    desc.frames = text(o.frames);
    desc.shard = text(o.shard);
    desc.cuts = text(o.cuts);
    desc.on_error = text(o.onError);
    desc.exposure = text(o.exposure);
    desc.strength = o.strength;
    desc.preserve = o.preserve;
    desc.recover = text(o.recover);
    desc.bidirectional = o.bidirectional;
    desc.resume = o.resume;
    use(desc);
}

/// What happens while a shot runs, without the GIL.
struct Run {
    py::object progress;  ///< callable or None
    std::exception_ptr thrown;
    std::mutex mutex;
    std::vector<std::string> warnings;

    static int32_t onProgress(void* user, uint32_t done, uint32_t total) {
        Run& run = *static_cast<Run*>(user);
        const py::gil_scoped_acquire acquire;
        try {
            handleSignals();
            if (!run.progress.is_none()) run.progress(done, total);
            return 0;
        } catch (...) {
            run.thrown = std::current_exception();
            return 1;
        }
    }
    static void onMessage(void* user, limpid_message_level level, const char* message) {
        if (level < LIMPID_MESSAGE_WARNING) return;
        Run& run = *static_cast<Run*>(user);
        const std::lock_guard lock(run.mutex);
        run.warnings.emplace_back(message);
    }
};

/// Returns the summary as a dict. Appends to `warnings`, also if the shot fails.
py::dict denoise(const Options& options, const std::string& select, const py::object& progress,
                 py::list warnings) {
    Run run;
    run.progress = progress;
    limpid_device_desc device{};
    device.size = sizeof device;
    device.select = select.c_str();
    device.message = Run::onMessage;
    device.message_user = &run;
    limpid_shot_summary summary{};
    summary.size = sizeof summary;
    limpid_result done = LIMPID_OK;
    withDesc(options, [&](limpid_shot_desc& desc) {
        desc.progress = Run::onProgress;
        desc.progress_user = &run;
        const py::gil_scoped_release release;
        done = limpid_shot_denoise(&device, &desc, &summary);
    });
    for (const std::string& text : run.warnings) warnings.append(textOf(text));
    check(done);
    if (run.thrown) std::rethrow_exception(std::exchange(run.thrown, nullptr));
    py::dict result;
    result["frames"] = summary.frames;
    result["kept"] = summary.kept;
    result["skipped"] = summary.skipped;
    result["cuts"] = summary.cuts;
    result["seconds"] = summary.seconds;
    return result;
}

py::str explain(const Options& options) {
    std::string lines;
    withDesc(options, [&](const limpid_shot_desc& desc) {
        const py::gil_scoped_release release;
        check(limpid_shot_explain(
            &desc, [](void* user, const char* text) { *static_cast<std::string*>(user) = text; }, &lines));
    });
    return textOf(lines);
}

}  // namespace

PYBIND11_MODULE(_shot, m) {
    translateFailures();
    py::class_<Options>(m, "Options")
        .def(py::init<>())
        .def_readwrite("input", &Options::input)
        .def_readwrite("output", &Options::output)
        .def_readwrite("denoiser", &Options::denoiser)
        .def_readwrite("preset", &Options::preset)
        .def_readwrite("weights", &Options::weights)
        .def_readwrite("map_file", &Options::mapFile)
        .def_readwrite("cameras", &Options::cameras)
        .def_readwrite("fps", &Options::fps)
        .def_readwrite("camera_start", &Options::cameraStart)
        .def_readwrite("motion", &Options::motion)
        .def_readwrite("frames", &Options::frames)
        .def_readwrite("shard", &Options::shard)
        .def_readwrite("cuts", &Options::cuts)
        .def_readwrite("on_error", &Options::onError)
        .def_readwrite("exposure", &Options::exposure)
        .def_readwrite("settings", &Options::settings)
        .def_readwrite("map", &Options::map)
        .def_readwrite("files", &Options::files)
        .def_readwrite("strength", &Options::strength)
        .def_readwrite("preserve", &Options::preserve)
        .def_readwrite("recover", &Options::recover)
        .def_readwrite("bidirectional", &Options::bidirectional)
        .def_readwrite("resume", &Options::resume);
    m.def("denoise", &denoise);
    m.def("explain", &explain);
}
