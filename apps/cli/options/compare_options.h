// What `limpid compare` was asked, shared by its two halves: one picture (compare.cpp) and sequences
// (compare_sequence.cpp).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/files/frame_pattern.h"
#include "image/image.h"
#include "image/io/picture.h"

namespace limpid::cli {

struct CompareOptions {
    FramePattern test;
    FramePattern reference;                ///< numbered only if test is
    std::optional<FramePattern> errorMap;  ///< numbered if test is
    std::optional<FramePattern> hdrErrorMap;
    std::optional<float> stops;  ///< of --exposure; none: not given, or auto
    bool autoExposure = false;   ///< --exposure auto; otherwise a reference that is PNG or JPEG gets 0 stops
    bool json = false;
};

/// Throws InputError unless both have the same size.
void checkSameSize(const std::filesystem::path& file, const image::Image& picture,
                   const std::filesystem::path& otherFile, const image::Image& other);

/// Throws InputError if the picture has a NaN or an infinity.
void checkReferenceFinite(const std::filesystem::path& file, const image::Image& reference);

/// Whether both pictures are scene-referred, as HDR-FLIP needs them. Throws UsageError if they are not, but
/// --hdr-error-map was given.
bool haveHdrFlip(const CompareOptions& options, const std::filesystem::path& testFile,
                 const image::Picture& test, const std::filesystem::path& referenceFile,
                 const image::Picture& reference);

/// Prints the scores of every frame, or throws; see compare_sequence.cpp.
void compareSequence(const CompareOptions& options);

}  // namespace limpid::cli
