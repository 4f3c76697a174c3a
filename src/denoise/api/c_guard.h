// The boundary of the C interface: turns exceptions into result codes and versioned structs into complete
// ones.
#pragma once

#include <algorithm>
#include <cstring>
#include <string>

#include "base/error.h"
#include "base/text/format.h"
#include "limpid/denoise.h"

namespace limpid::denoise {

/// Of the calling thread's last failure; "" if there was none.
const char* lastErrorText() noexcept;

/// Stores the message of the calling thread and tells the code of the exception that is being handled.
limpid_result resultOfException() noexcept;

/// Runs `action` and returns the result code. Does not throw.
template <typename Action>
limpid_result guarded(const Action& action) noexcept {
    try {
        action();
        return LIMPID_OK;
    } catch (...) {
        return resultOfException();
    }
}

template <typename T>
T& required(T* pointer, const char* name) {
    if (!pointer) throw UsageError(formatText("{} is NULL", name));
    return *pointer;
}

/// Converts a struct of any version: members that the caller does not know become 0; members that we do not
/// know must be 0.
template <typename T>
T wholeStruct(const T* given, const char* name) {
    const size_t size = required(given, name).size;
    if (size < sizeof(size_t)) throw UsageError(formatText("{}: its member `size` is {}", name, size));
    const auto* bytes = reinterpret_cast<const unsigned char*>(given);
    if (size > sizeof(T) &&
        std::any_of(bytes + sizeof(T), bytes + size, [](unsigned char b) { return b != 0; }))
        throw UsageError(formatText("{} uses members of a later version of Limpid", name));
    T whole{};
    std::memcpy(&whole, given, std::min(size, sizeof(T)));
    return whole;
}

}  // namespace limpid::denoise
