#include "denoise/api/c_guard.h"

#include <new>

#include "gpu/vulkan/device.h"

namespace limpid::denoise {
namespace {

thread_local std::string lastError;

}  // namespace

const char* lastErrorText() noexcept {
    return lastError.c_str();
}

limpid_result resultOfException() noexcept {
    const auto say = [](const char* text, limpid_result result) noexcept {
        try {
            lastError = text;
        } catch (...) {
            lastError.clear();
        }
        return result;
    };
    try {
        throw;
    } catch (const gpu::DeviceLost& error) {
        return say(error.what(), LIMPID_ERROR_DEVICE_LOST);
    } catch (const gpu::OutOfMemory& error) {
        return say(error.what(), LIMPID_ERROR_OUT_OF_MEMORY);
    } catch (const gpu::Unsupported& error) {
        return say(error.what(), LIMPID_ERROR_UNSUPPORTED);
    } catch (const UsageError& error) {
        return say(error.what(), LIMPID_ERROR_INVALID_ARGUMENT);
    } catch (const InputError& error) {
        return say(error.what(), LIMPID_ERROR_UNREADABLE);
    } catch (const std::bad_alloc&) {
        return say("out of host memory", LIMPID_ERROR_OUT_OF_MEMORY);
    } catch (const std::exception& error) {
        return say(error.what(), LIMPID_ERROR_FAILED);
    } catch (...) {
        return say("unknown failure", LIMPID_ERROR_FAILED);
    }
}

}  // namespace limpid::denoise
