// The report of `limpid bench quality`: one HTML page that needs nothing but itself.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "lab/quality/quality_run.h"

namespace limpid::cli {

/// Numbers, pictures of the compared frames and what shows them (quality_page.html).
std::string qualityPage(const QualityRun& run);

/// Drops the pictures of frames until the rest take at most `bytes`: keeps every n-th frame, counted back
/// from the last, with the smallest n that suffices. Dropped pictures become empty. The last frame is always
/// kept.
void keepWithin(SequenceQuality& quality, uint64_t bytes);

/// qualityPage(), atomically. Throws OutputError.
void writeQualityPage(const std::filesystem::path& file, const QualityRun& run);

/// JSON that may stand within <script type="application/json">: the same value, but nothing in it can end the
/// element or begin a comment. ASCII only.
std::string jsonForScript(const nlohmann::ordered_json& json);

/// RFC 4648, padded.
std::string base64(std::span<const char> bytes);

}  // namespace limpid::cli
