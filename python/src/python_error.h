// Raises limpid.Error in Python for C++ exceptions.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace limpid::python {

/// Sets the Python error indicator to limpid.Error(message, code). `code` is one of those in
/// limpid/_error.py. The caller must hold the GIL.
inline void raiseError(const std::string& message, const char* code) {
    const pybind11::object type = pybind11::module_::import("limpid._error").attr("Error");
    const pybind11::object error = type(message, code);
    PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace limpid::python
