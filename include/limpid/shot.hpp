// Limpid for files of any renderer, in C++17: wraps shot.h in exceptions instead of result codes, and structs
// with default values. Everything is inline: only C symbols of liblimpid-shot are linked.
//
//     limpid::ShotDesc shot("shot.%04d.exr", "clean.%04d.exr");
//     limpid::denoiseShot(shot);
//
// See shot.h for members, units, ranges and rules.
#ifndef LIMPID_SHOT_HPP
#define LIMPID_SHOT_HPP

#include <limpid/shot.h>

#include <limpid/denoise.hpp>

namespace limpid {
inline namespace v0 {

/// Throws Error unless `result`, of a limpid_shot_* function, is LIMPID_OK.
inline void checkShot(limpid_result result) {
    if (result != LIMPID_OK) throw Error(result, limpid_shot_last_error());
}

/// The texts must live as long as it is used.
struct ShotDesc : Sized<limpid_shot_desc> {
    ShotDesc() = default;
    explicit ShotDesc(const char* from, const char* to = nullptr) noexcept {
        input = from;
        output = to;
    }
};

using ShotSummary = Sized<limpid_shot_summary>;

/// Denoises a shot on the best device, or on that of `device`.
inline ShotSummary denoiseShot(const limpid_shot_desc& shot, const limpid_device_desc& device = DeviceDesc()) {
    ShotSummary summary;
    checkShot(limpid_shot_denoise(&device, &shot, &summary));
    return summary;
}

/// Returns how the files' layers are understood, in several lines.
inline std::string explainShot(const limpid_shot_desc& shot) {
    std::string lines;
    checkShot(limpid_shot_explain(
        &shot, [](void* user, const char* text) { *static_cast<std::string*>(user) = text; }, &lines));
    return lines;
}

}  // namespace v0
}  // namespace limpid

#endif
