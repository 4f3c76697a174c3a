// limpid._denoise: the C interface (limpid/denoise.h) for Python. limpid/_denoising.py checks arguments and
// documents them.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "c_interface.h"
#include "gil.h"
#include "limpid/denoise.h"

namespace py = pybind11;

namespace {

using namespace limpid::python;

/// Throws Failure if a call failed. Must run on the same thread as the call, since the error text is per
/// thread.
void check(limpid_result result) {
    if (result != LIMPID_OK) throw Failure(limpid_last_error(), result);
}

const char* nameOf(limpid_message_level level) {
    constexpr const char* names[] = {"debug", "info", "warning", "error"};
    return level >= LIMPID_MESSAGE_DEBUG && level <= LIMPID_MESSAGE_ERROR ? names[level] : "error";
}

using Message = std::pair<std::string, std::string>;  ///< level, text

class Device {
  public:
    Device(const std::string& select, bool validation) {
        limpid_device_desc desc{};
        desc.size = sizeof desc;
        desc.select = select.c_str();
        desc.validation = validation ? 1 : 0;
        desc.message = [](void* user, limpid_message_level level, const char* text) {
            static_cast<Device*>(user)->keep(nameOf(level), text);
        };
        desc.message_user = this;
        limpid_device* device = nullptr;
        check(limpid_device_create(&desc, &device));
        handle_.reset(device);
    }

    limpid_device* handle() const { return handle_.get(); }
    std::string name() const { return limpid_device_name(handle_.get()); }

    /// Returns the messages since the last call.
    std::vector<Message> messages() {
        const std::lock_guard lock(mutex_);
        return std::exchange(messages_, {});
    }

    py::bytes pipelineCache() const {
        const std::string data = [&] {
            const py::gil_scoped_release release;
            return readPipelineCache();
        }();
        return data;
    }
    void loadPipelineCache(std::string_view data) {
        check(limpid_device_load_pipeline_cache(handle_.get(), data.data(), data.size()));
    }

  private:
    std::string readPipelineCache() const {
        while (true) {
            size_t size = 0;
            check(limpid_device_pipeline_cache(handle_.get(), nullptr, &size));
            std::string data(size, '\0');
            const limpid_result result = limpid_device_pipeline_cache(handle_.get(), data.data(), &size);
            // Another thread has made pipelines meanwhile, and they do not fit.
            if (result == LIMPID_ERROR_INVALID_ARGUMENT) continue;
            check(result);
            data.resize(size);
            return data;
        }
    }
    /// Called from any thread, with or without the GIL, so it must not use Python.
    void keep(const char* level, const char* text) {
        const std::lock_guard lock(mutex_);
        messages_.emplace_back(level, text);
    }

    struct Destroy {
        void operator()(limpid_device* device) const { limpid_device_destroy(device); }
    };
    std::mutex mutex_;
    std::vector<Message> messages_;
    std::unique_ptr<limpid_device, Destroy> handle_;  ///< destroyed first, since that may still produce
                                                      ///< messages
};

using Matrices = py::array_t<float, py::array::c_style | py::array::forcecast>;

void copyMatrix(const float* from, float (&to)[16]) {
    std::copy(from, from + 16, to);
}

/// `matrices`: view, projection, previous view, previous projection, each in column-major order.
limpid_camera cameraOf(const Matrices& matrices, std::pair<float, float> jitter) {
    if (matrices.size() != 64) throw std::invalid_argument("the camera has four matrices of 4 x 4");
    limpid_camera camera{};
    const float* data = matrices.data();
    copyMatrix(data, camera.view);
    copyMatrix(data + 16, camera.projection);
    copyMatrix(data + 32, camera.previous_view);
    copyMatrix(data + 48, camera.previous_projection);
    camera.jitter[0] = jitter.first;
    camera.jitter[1] = jitter.second;
    return camera;
}

class Denoiser {
  public:
    Denoiser(std::shared_ptr<Device> device, const limpid_denoiser_desc& desc)
        : device_(std::move(device)), size_(Size{desc.width, desc.height}) {
        limpid_denoiser* denoiser = nullptr;
        check(limpid_denoiser_create(device_->handle(), &desc, &denoiser));
        handle_.reset(denoiser);
    }

    /// `inputs`: limpid_input and a float array of (height, width, components) with contiguous components.
    /// Returns an array of (height, width, 3) for each of `outputs` (limpid_output).
    py::list denoise(const std::vector<std::pair<uint32_t, Array>>& inputs,
                     const std::vector<uint32_t>& outputs, const Matrices& camera,
                     std::pair<float, float> jitter, bool reset) {
        const Size size = size_;
        limpid_host_frame frame{};
        frame.size = sizeof frame;
        frame.reset = reset ? 1 : 0;
        frame.camera = cameraOf(camera, jitter);
        for (const auto& [input, array] : inputs) {
            if (input >= LIMPID_INPUT_MAX) throw std::invalid_argument("there is no such input");
            checkReadable(array, size.width, size.height);
            frame.inputs[input] = hostImage<limpid_host_image>(array.data(), array);
        }
        py::list results;
        for (const uint32_t output : outputs) {
            if (output >= LIMPID_OUTPUT_MAX) throw std::invalid_argument("there is no such output");
            Array result({py::ssize_t{size.height}, py::ssize_t{size.width}, py::ssize_t{3}});
            frame.outputs[output] = hostImage<limpid_host_output>(result.mutable_data(), result);
            results.append(std::move(result));
        }
        const py::gil_scoped_release release;
        const std::lock_guard lock(mutex_);
        // The arrays have the size from before: the library would read and write beyond their ends.
        if (size_ != size) throw std::invalid_argument("another thread resized the denoiser meanwhile");
        check(limpid_denoise_host(handle_.get(), &frame));
        return results;
    }

    void resize(uint32_t width, uint32_t height) {
        const std::lock_guard lock(mutex_);
        check(limpid_denoiser_resize(handle_.get(), width, height));
        size_ = Size{width, height};
    }
    void reset() {
        const std::lock_guard lock(mutex_);
        check(limpid_denoiser_reset(handle_.get()));
    }
    void set(const std::string& name, double value) {
        const std::lock_guard lock(mutex_);
        check(limpid_denoiser_set(handle_.get(), name.c_str(), value));
    }
    double get(const std::string& name) {
        const std::lock_guard lock(mutex_);
        double value = 0.0;
        check(limpid_denoiser_get(handle_.get(), name.c_str(), &value));
        return value;
    }

    std::vector<std::pair<std::string, double>> timings() {
        const std::lock_guard lock(mutex_);
        uint32_t count = 0;
        check(limpid_denoiser_timings(handle_.get(), nullptr, &count));
        std::vector<limpid_timing> timings(count);
        check(limpid_denoiser_timings(handle_.get(), timings.data(), &count));
        std::vector<std::pair<std::string, double>> result;
        for (uint32_t i = 0; i < count; ++i) result.emplace_back(timings[i].pass, timings[i].milliseconds);
        return result;
    }

    uint32_t width() const { return size_.load().width; }
    uint32_t height() const { return size_.load().height; }

  private:
    struct Size {
        uint32_t width, height;
        bool operator==(const Size&) const = default;
    };
    struct Destroy {
        void operator()(limpid_denoiser* denoiser) const { limpid_denoiser_destroy(denoiser); }
    };
    std::shared_ptr<Device> device_;
    std::atomic<Size> size_;  ///< changes only under the mutex, but is read without it
    std::mutex mutex_;        ///< one thread at a time may use a denoiser, and the GIL is released meanwhile
    std::unique_ptr<limpid_denoiser, Destroy> handle_;
};

limpid_denoiser_desc describe(int method, uint32_t width, uint32_t height, uint32_t signals, bool demodulated,
                              int normalEncoding, int normalSpace, int depth, float farDepth, int motionUnit,
                              int motionDirection, int motionDepth, int clipY, bool timings,
                              uint32_t samples) {
    limpid_denoiser_desc desc{};
    desc.size = sizeof desc;
    desc.method = static_cast<limpid_method>(method);
    desc.width = width;
    desc.height = height;
    desc.signals = signals;
    desc.demodulated = demodulated ? 1 : 0;
    desc.normal_encoding = static_cast<limpid_normal_encoding>(normalEncoding);
    desc.normal_space = static_cast<limpid_space>(normalSpace);
    desc.depth = static_cast<limpid_depth>(depth);
    desc.far_depth = farDepth;
    desc.motion_unit = static_cast<limpid_motion_unit>(motionUnit);
    desc.motion_direction = static_cast<limpid_motion_direction>(motionDirection);
    desc.motion_depth = static_cast<limpid_motion_depth>(motionDepth);
    desc.clip_y = static_cast<limpid_clip_y>(clipY);
    desc.timings = timings ? 1 : 0;
    desc.samples = samples;
    return desc;
}

std::vector<Parameter> parameters(int method) {
    return listParameters([method](uint32_t index, limpid_parameter* p) {
        return limpid_method_parameter(static_cast<limpid_method>(method), index, p);
    });
}

using Names = std::vector<std::pair<const char*, int>>;

/// Adds a dict from names in Python to numbers in C.
void addNames(py::module_& module, const char* table, const Names& names) {
    py::dict dict;
    for (const auto& [name, value] : names) dict[name] = value;
    module.attr(table) = dict;
}

void addTables(py::module_& m) {
    addNames(m, "METHODS",
             {{"svgf", LIMPID_METHOD_SVGF},
              {"atrous", LIMPID_METHOD_ATROUS},
              {"temporal", LIMPID_METHOD_TEMPORAL},
              {"bilateral", LIMPID_METHOD_BILATERAL},
              {"visibility", LIMPID_METHOD_VISIBILITY},
              {"nano", LIMPID_METHOD_NANO},
              {"film", LIMPID_METHOD_FILM}});
    addNames(m, "NORMAL_ENCODINGS",
             {{"signed", LIMPID_NORMAL_SIGNED},
              {"unorm", LIMPID_NORMAL_UNORM},
              {"octahedral_signed", LIMPID_NORMAL_OCTAHEDRAL_SIGNED},
              {"octahedral_unorm", LIMPID_NORMAL_OCTAHEDRAL_UNORM}});
    addNames(m, "NORMAL_SPACES", {{"world", LIMPID_SPACE_WORLD}, {"view", LIMPID_SPACE_VIEW}});
    addNames(m, "DEPTH_ENCODINGS",
             {{"distance", LIMPID_DEPTH_DISTANCE},
              {"linear", LIMPID_DEPTH_LINEAR},
              {"device", LIMPID_DEPTH_DEVICE}});
    addNames(m, "MOTION_UNITS",
             {{"pixels", LIMPID_MOTION_PIXELS}, {"uv", LIMPID_MOTION_UV}, {"ndc", LIMPID_MOTION_NDC}});
    addNames(m, "MOTION_DIRECTIONS",
             {{"to_previous", LIMPID_MOTION_TO_PREVIOUS}, {"from_previous", LIMPID_MOTION_FROM_PREVIOUS}});
    addNames(m, "MOTION_DEPTHS", {{"2d", LIMPID_MOTION_2D}, {"distance", LIMPID_MOTION_DISTANCE}});
    addNames(m, "CLIP_Y", {{"down", LIMPID_CLIP_Y_DOWN}, {"up", LIMPID_CLIP_Y_UP}});
    addNames(m, "INPUTS",
             {{"radiance", LIMPID_INPUT_RADIANCE},
              {"specular", LIMPID_INPUT_SPECULAR},
              {"emission", LIMPID_INPUT_EMISSION},
              {"albedo", LIMPID_INPUT_ALBEDO},
              {"albedo_specular", LIMPID_INPUT_ALBEDO_SPECULAR},
              {"normal", LIMPID_INPUT_NORMAL},
              {"depth", LIMPID_INPUT_DEPTH},
              {"motion", LIMPID_INPUT_MOTION},
              {"previous_normal", LIMPID_INPUT_PREVIOUS_NORMAL},
              {"reflection_motion", LIMPID_INPUT_REFLECTION_MOTION},
              {"id", LIMPID_INPUT_ID},
              {"roughness", LIMPID_INPUT_ROUGHNESS},
              {"hit_distance", LIMPID_INPUT_HIT_DISTANCE},
              {"radiance_variance", LIMPID_INPUT_RADIANCE_VARIANCE},
              {"specular_variance", LIMPID_INPUT_SPECULAR_VARIANCE}});
    addNames(m, "OUTPUTS",
             {{"color", LIMPID_OUTPUT_COLOR},
              {"radiance", LIMPID_OUTPUT_RADIANCE},
              {"specular", LIMPID_OUTPUT_SPECULAR}});
}

std::string version() {
    const uint32_t v = limpid_version();
    return std::to_string(v / 10000) + "." + std::to_string(v / 100 % 100) + "." + std::to_string(v % 100);
}

}  // namespace

PYBIND11_MODULE(_denoise, m) {
    translateFailures();
    using Unlocked = py::call_guard<py::gil_scoped_release>;
    m.def("version", version);
    m.def("parameters", parameters);
    addTables(m);
    py::class_<Device, std::shared_ptr<Device>>(m, "Device")
        .def(py::init<const std::string&, bool>(), Unlocked())
        .def("name", &Device::name)
        .def("messages", &Device::messages)
        .def("pipeline_cache", &Device::pipelineCache)
        .def("load_pipeline_cache", &Device::loadPipelineCache, Unlocked());
    py::class_<limpid_denoiser_desc>(m, "Description")
        .def(py::init(&describe), py::kw_only(), py::arg("method"), py::arg("width"), py::arg("height"),
             py::arg("signals"), py::arg("demodulated"), py::arg("normal_encoding"), py::arg("normal_space"),
             py::arg("depth_encoding"), py::arg("far_depth"), py::arg("motion_unit"),
             py::arg("motion_direction"), py::arg("motion_depth"), py::arg("clip_y"), py::arg("timings"),
             py::arg("samples"));
    py::class_<Denoiser, std::unique_ptr<Denoiser, DestroyUnlocked<Denoiser>>>(m, "Denoiser")
        .def(py::init<std::shared_ptr<Device>, const limpid_denoiser_desc&>(), Unlocked())
        .def("denoise", &Denoiser::denoise)
        .def("resize", &Denoiser::resize, Unlocked())
        .def("reset", &Denoiser::reset, Unlocked())
        .def("set", &Denoiser::set, Unlocked())
        .def("get", &Denoiser::get, Unlocked())
        .def("timings", &Denoiser::timings, Unlocked())
        .def_property_readonly("width", &Denoiser::width)
        .def_property_readonly("height", &Denoiser::height);
}
