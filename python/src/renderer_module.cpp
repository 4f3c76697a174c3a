// limpid._renderer: rendering of scenes, and metrics, for Python. limpid/_rendering.py checks arguments and
// documents them.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gil.h"
#include "gpu/vulkan/device.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "python_error.h"
#include "renderer/layers/layers.h"
#include "scene/builtin/builtin.h"
#include "scene_renderer.h"

namespace py = pybind11;

namespace limpid::python {
namespace {

/// Raises the exception that is being handled.
void raiseAsPython(std::exception_ptr thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const gpu::DeviceLost& error) {
        raiseError(error.what(), "device_lost");
    } catch (const gpu::OutOfMemory& error) {
        raiseError(error.what(), "out_of_memory");
    } catch (const gpu::Unsupported& error) {
        raiseError(error.what(), "unsupported");
    } catch (const Error& error) {
        raiseError(error.what(), error.code() == ExitCode::Usage      ? "invalid_argument"
                                 : error.code() == ExitCode::BadInput ? "unreadable"
                                                                      : "failed");
    }
}

using Array = py::array_t<float, py::array::c_style | py::array::forcecast>;

image::Image imageOf(const Array& array) {
    if (array.ndim() != 3 || array.shape(2) > 4) throw UsageError("a picture is (height, width, components)");
    image::Image picture(static_cast<uint32_t>(array.shape(1)), static_cast<uint32_t>(array.shape(0)),
                         static_cast<uint32_t>(array.shape(2)));
    std::copy(array.data(), array.data() + array.size(), picture.pixels.begin());
    return picture;
}

py::dict compare(const Array& test, const Array& reference, std::optional<float> stops) {
    const image::Comparison result = [&] {
        const py::gil_scoped_release release;
        const image::Image a = imageOf(test), b = imageOf(reference);
        return image::compare(a, b, stops ? *stops : image::autoExposure(b));
    }();
    py::dict dict;
    dict["psnr"] = result.psnr;
    dict["ssim"] = result.ssim;
    dict["flip"] = result.flip;
    dict["relmse"] = result.relMse;
    dict["exposure"] = result.exposure;
    dict["invalid_pixels"] = result.invalidPixels;
    return dict;
}

/// A layer of the EXR files, and its name in Python.
struct Layer {
    const char* name;
    const char* layer;
    const char* suffixes;
};
constexpr Layer colors[] = {{"color", "", "RGB"},
                            {"diffuse", "diffuse", "RGB"},
                            {"specular", "specular", "RGB"},
                            {"emission", "emission", "RGB"},
                            {"albedo", "albedo", "RGB"},
                            {"albedo_specular", "albedoSpecular", "RGB"},
                            {"normal", "normal", "XYZ"},
                            {"previous_normal", "prevNormal", "XYZ"},
                            {"depth", "depth", "Z"},
                            {"motion", "motion", "XYZ"},
                            {"reflection_motion", "reflectionMotion", "XYZ"},
                            {"roughness", "roughness", "R"},
                            {"hit_distance", "hitDistance", "D"},
                            {"id", "id", "I"}};
constexpr const char* varianceOf[] = {"diffuse", "specular", "albedo", "normal", "depth"};

using Pictures = std::vector<std::pair<std::string, image::Image>>;

/// The layers by their names in Python. Copies all pixels, so call it without the GIL.
Pictures picturesOf(const image::LayeredImage& layers) {
    Pictures pictures;
    for (const auto& [name, layer, suffixes] : colors) {
        const std::string channel =
            std::string(layer) + (layer[0] == '\0' ? "" : ".") + std::string(1, suffixes[0]);
        if (layers.find(channel)) pictures.emplace_back(name, layers.get(layer, suffixes));
    }
    for (const std::string name : varianceOf) {
        if (layers.find(name + ".variance.V"))
            pictures.emplace_back(name + "_variance", layers.get(name + ".variance", "V"));
    }
    return pictures;
}

/// Returns (height, width) for one component, (height, width, n) for several. Takes the pixels over.
py::array_t<float> arrayOf(image::Image&& picture) {
    std::vector<py::ssize_t> shape{py::ssize_t{picture.height}, py::ssize_t{picture.width}};
    if (picture.components > 1) shape.push_back(py::ssize_t{picture.components});
    using Pixels = std::vector<float>;
    auto pixels = std::make_unique<Pixels>(std::move(picture.pixels));
    const float* const data = pixels->data();
    const py::capsule owner(pixels.get(), [](void* taken) { delete static_cast<Pixels*>(taken); });
    static_cast<void>(pixels.release());  // the capsule has it now
    return py::array_t<float>(shape, data, owner);
}

py::dict arraysOf(Pictures&& pictures) {
    py::dict dict;
    for (auto& [name, picture] : pictures) dict[name.c_str()] = arrayOf(std::move(picture));
    if (dict.contains("id")) dict["id"] = dict["id"].attr("astype")("uint32");
    return dict;
}

std::vector<float> components(const vec3& v) {
    return {v.x, v.y, v.z};
}

py::dict cameraDict(const CameraParams& camera) {
    py::dict dict;
    dict["origin"] = components(camera.origin);
    dict["forward"] = components(camera.forward);
    dict["right"] = components(camera.right);
    dict["up"] = components(camera.up);
    dict["orthographic"] = camera.orthographic != 0;
    return dict;
}

/// Lets Python handle signals, such as Ctrl+C, ten times a second. For calls without the GIL.
class SignalCheck {
  public:
    void operator()() {
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return;
        next_ = now + std::chrono::milliseconds(100);
        const py::gil_scoped_acquire acquire;
        handleSignals();
    }

  private:
    std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
};

/// Returns the layers of a frame by name, and its camera.
py::tuple render(SceneRenderer& renderer, uint64_t frame) {
    auto [pictures, camera] = [&] {
        const py::gil_scoped_release release;
        const auto [layers, seenFrom] = renderer.render(frame, SignalCheck());
        return std::pair(picturesOf(layers), seenFrom);
    }();
    return py::make_tuple(arraysOf(std::move(pictures)), cameraDict(camera));
}

std::vector<std::pair<std::string, std::string>> builtinScenes() {
    std::vector<std::pair<std::string, std::string>> all;
    for (const scene::BuiltinInfo& info : scene::builtinScenes())
        all.emplace_back("builtin:" + info.name, info.help);
    return all;
}

RenderOptions optionsOf(const py::kwargs& given) {
    RenderOptions o;
    const auto take = [&](const char* name, auto& member) {
        member = given[name].cast<std::remove_reference_t<decltype(member)>>();
    };
    take("scene", o.source.scene);
    take("width", o.width);
    take("height", o.height);
    take("samples", o.samples);
    take("seed", o.seed);
    take("denoiser", o.denoiser);
    take("assignments", o.assignments);
    take("environment", o.source.environment);
    take("camera", o.camera);
    take("eye", o.eye);
    take("target", o.target);
    take("fov", o.fov);
    take("jitter", o.jitter);
    take("weights", o.weights);
    take("asset_root", o.source.assetRoot);
    take("fps", o.timing.framesPerSecond);
    take("shutter", o.timing.shutter.open);
    o.timing.shutter.position = limpid::parseShutterPosition(given["shutter_position"].cast<std::string>());
    take("frames", o.frames);
    take("animation", o.animation);
    take("camera_path", o.cameraPath);
    return o;
}

}  // namespace
}  // namespace limpid::python

PYBIND11_MODULE(_renderer, m) {
    using namespace limpid::python;
    py::register_local_exception_translator(raiseAsPython);
    using Unlocked = py::call_guard<py::gil_scoped_release>;
    m.def("compare", compare);
    m.def("builtin_scenes", builtinScenes);
    py::class_<RenderDevice, std::shared_ptr<RenderDevice>>(m, "Device")
        .def(py::init<const std::string&>(), Unlocked());
    py::class_<RenderOptions>(m, "Options").def(py::init(&optionsOf));
    py::class_<SceneRenderer, std::unique_ptr<SceneRenderer, DestroyUnlocked<SceneRenderer>>>(m, "Renderer")
        .def(py::init<std::shared_ptr<RenderDevice>, const RenderOptions&>(), Unlocked())
        .def("render", render);
}
