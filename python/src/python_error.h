// Raises limpid.Error in Python for C++ exceptions, and passes texts on.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace limpid::python {

/// Text that may contain names of files. Bytes that are not UTF-8 become "\xff" and so on.
inline pybind11::str textOf(const std::string& text) {
    const auto size = static_cast<Py_ssize_t>(text.size());
    PyObject* const decoded = PyUnicode_DecodeUTF8(text.data(), size, "backslashreplace");
    if (!decoded) throw pybind11::error_already_set();
    return pybind11::reinterpret_steal<pybind11::str>(decoded);
}

/// Sets the Python error indicator to limpid.Error(message, code). `code` is one of those in
/// limpid/_error.py. The caller must hold the GIL.
inline void raiseError(const std::string& message, const char* code) {
    const pybind11::object type = pybind11::module_::import("limpid._error").attr("Error");
    const pybind11::object error = type(textOf(message), code);
    PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace limpid::python
