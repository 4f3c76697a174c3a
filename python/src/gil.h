// Work without Python's global lock (GIL), so that other Python threads run meanwhile.
#pragma once

#include <pybind11/pybind11.h>

namespace limpid::python {

/// Lets Python handle signals, such as Ctrl+C. Throws what a handler raises. The caller must hold the GIL; on
/// other threads than Python's main one this does nothing.
inline void handleSignals() {
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

/// Destroys an object without the GIL: it may have to wait for others that use the device.
template <typename T>
struct DestroyUnlocked {
    void operator()(T* object) const {
        const pybind11::gil_scoped_release release;
        delete object;
    }
};

}  // namespace limpid::python
