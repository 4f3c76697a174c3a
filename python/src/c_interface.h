// Shared by the extension modules for the two C interfaces (limpid/denoise.h and limpid/neural.h).
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "limpid/denoise.h"
#include "python_error.h"

namespace limpid::python {

struct Failure : std::runtime_error {
    Failure(const char* message, limpid_result what) : std::runtime_error(message), result(what) {}
    limpid_result result;
};

inline const char* codeOf(limpid_result result) {
    switch (result) {
        case LIMPID_ERROR_INVALID_ARGUMENT:
            return "invalid_argument";
        case LIMPID_ERROR_UNSUPPORTED:
            return "unsupported";
        case LIMPID_ERROR_OUT_OF_MEMORY:
            return "out_of_memory";
        case LIMPID_ERROR_DEVICE_LOST:
            return "device_lost";
        case LIMPID_ERROR_UNREADABLE:
            return "unreadable";
        default:
            return "failed";
    }
}

/// Registers the translation of Failure to limpid.Error for the module that is being initialised.
inline void translateFailures() {
    pybind11::register_local_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown) std::rethrow_exception(thrown);
        } catch (const Failure& failure) {
            raiseError(failure.what(), codeOf(failure.result));
        }
    });
}

using Array = pybind11::array_t<float>;

/// Describes an array (height, width, components) as an image of the C interface, without copying it.
template <typename Image, typename Data>
Image hostImage(Data* data, const Array& array) {
    // NumPy's strides along an axis of length 1 are arbitrary; 0 is the C interface's default.
    const auto stride = [&](int axis) {
        return array.shape(axis) > 1 ? static_cast<size_t>(array.strides(axis)) : 0;
    };
    Image image{};
    image.data = data;
    image.components = static_cast<uint32_t>(array.shape(2));
    image.pixel_stride = stride(1);
    image.row_stride = stride(0);
    return image;
}

/// Throws std::invalid_argument unless the array has the shape (height, width, 1 to 4), positive strides, and
/// adjacent components.
inline void checkReadable(const Array& array, uint32_t width, uint32_t height) {
    using pybind11::ssize_t;
    const bool shaped = array.ndim() == 3 && array.shape(0) == ssize_t{height} &&
                        array.shape(1) == ssize_t{width} && array.shape(2) >= 1 && array.shape(2) <= 4;
    const auto forwards = [&](int axis) { return array.shape(axis) == 1 || array.strides(axis) > 0; };
    if (!shaped || !forwards(0) || !forwards(1) ||
        !(array.shape(2) == 1 || array.strides(2) == ssize_t{sizeof(float)}))
        throw std::invalid_argument("an input's shape or strides cannot be read");
}

/// A parameter as Python gets it: name, type, default, minimum, maximum, unit, help.
using Parameter = std::tuple<std::string, std::string, double, double, double, std::string, std::string>;

/// Lists all parameters. `get(index, &parameter)` is a function of the C interface.
template <typename Get>
std::vector<Parameter> listParameters(const Get& get) {
    constexpr const char* types[] = {"bool", "int", "float"};
    std::vector<Parameter> all;
    limpid_parameter p{};
    while (get(static_cast<uint32_t>(all.size()), &p) == LIMPID_OK)
        all.emplace_back(p.name, types[p.type], p.default_value, p.minimum, p.maximum, p.unit, p.help);
    return all;
}

}  // namespace limpid::python
