#include "renderer/long/sums/accumulation_header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/hash.h"
#include "base/log.h"
#include "image/io/rows/limits.h"
#include "image/tone_curve.h"
#include "renderer/layers/layers.h"
#include "renderer/layers/picture_name.h"

namespace limpid {
namespace {

constexpr size_t maxFinishedRanges = 4096;
constexpr size_t maxIdentityEntries = 256;
constexpr uint64_t maxFrames = uint64_t{1} << 32;

using Json = nlohmann::ordered_json;

/// Reads and checks values; throws InputError if one is invalid.
class HeaderReader {
  public:
    HeaderReader(std::string_view text, const std::filesystem::path& file)
        : file_(file), json_(Json::parse(text, nullptr, false)) {
        if (!json_.is_object()) fail("has a damaged header");
    }

    uint64_t number(const char* name, uint64_t min, uint64_t max) const {
        return number(name, at(name), min, max);
    }
    uint64_t number(const char* name, const Json& json, uint64_t min, uint64_t max) const {
        if (!json.is_number_unsigned()) fail(fmt::format("'{}' is no number", name));
        const uint64_t value = json.get<uint64_t>();
        if (value < min || value > max)
            fail(fmt::format("'{}' is {}, outside {} to {}", name, value, min, max));
        return value;
    }
    std::string text(const char* name, const Json& json) const {
        if (!json.is_string()) fail(fmt::format("'{}' is no text", name));
        return json.get<std::string>();
    }
    const Json& array(const char* name) const {
        if (!at(name).is_array()) fail(fmt::format("'{}' is no list", name));
        return at(name);
    }
    const Json& pair(const char* name, const Json& json) const {
        if (!json.is_array() || json.size() != 2) fail(fmt::format("'{}' holds no pair", name));
        return json;
    }
    bool flag(const char* name) const {
        if (!at(name).is_boolean()) fail(fmt::format("'{}' is neither true nor false", name));
        return at(name).get<bool>();
    }
    bool has(const char* name) const { return json_.contains(name); }
    const Json& at(const char* name) const {
        const auto found = json_.find(name);
        if (found == json_.end()) fail(fmt::format("has no '{}' in its header", name));
        return *found;
    }
    [[noreturn]] void fail(const std::string& fault) const { throw InputError(file_, fault); }

  private:
    const std::filesystem::path& file_;
    Json json_;
};

std::vector<std::string> layersOf(const HeaderReader& reader) {
    std::vector<std::string> layers;
    auto next = layerNames().begin();
    for (const Json& json : reader.array("layers")) {
        const std::string name = reader.text("layers", json);
        next = std::find(next, layerNames().end(), name);
        if (next == layerNames().end())
            reader.fail(fmt::format("the layer '{}' is unknown or misplaced", name));
        layers.push_back(*next++);
    }
    return layers;
}

std::vector<std::pair<std::string, std::string>> readIdentity(const HeaderReader& reader) {
    std::vector<std::pair<std::string, std::string>> identity;
    if (reader.array("identity").size() > maxIdentityEntries) reader.fail("has too long an identity");
    for (const Json& json : reader.array("identity")) {
        const Json& entry = reader.pair("identity", json);
        const std::string name = reader.text("identity", entry[0]);
        const bool twice = std::any_of(identity.begin(), identity.end(),
                                       [&](const auto& earlier) { return earlier.first == name; });
        if (twice) reader.fail(fmt::format("names '{}' twice in its identity", name));
        identity.emplace_back(name, reader.text("identity", entry[1]));
    }
    return identity;
}

BlockPlan planOf(const HeaderReader& reader) {
    BlockPlan plan;
    plan.samples = reader.number("samples", 1, maxSamplesPerPixel);
    plan.blockSamples = static_cast<uint32_t>(reader.number("block_samples", 1, maxBlockSamples));
    plan.launchSamples = static_cast<uint32_t>(reader.number("launch_samples", 1, plan.blockSamples));
    return plan;
}

Shard shardOf(const HeaderReader& reader) {
    Shard shard;
    shard.count = static_cast<uint32_t>(reader.number("shards", 1, UINT32_MAX));
    shard.index = static_cast<uint32_t>(reader.number("shard", 1, shard.count));
    return shard;
}

gpu::Extent extentOf(const HeaderReader& reader) {
    constexpr uint64_t max = 65535;
    const gpu::Extent extent{static_cast<uint32_t>(reader.number("width", 1, max)),
                             static_cast<uint32_t>(reader.number("height", 1, max))};
    if (uint64_t{extent.width} * extent.height > image::maxPixels) reader.fail("is of too large a picture");
    return extent;
}

std::vector<std::pair<uint64_t, uint64_t>> finishedOf(const HeaderReader& reader, uint64_t frames) {
    std::vector<std::pair<uint64_t, uint64_t>> ranges;
    if (reader.array("finished").size() > maxFinishedRanges)
        reader.fail("has too long a list of finished frames");
    uint64_t min = 0;
    for (const Json& json : reader.array("finished")) {
        const Json& range = reader.pair("finished", json);
        const uint64_t first = reader.number("finished", range[0], min, frames);
        const uint64_t last = reader.number("finished", range[1], first, frames);
        if (last == frames) reader.fail("has a finished frame that its shard lacks");
        ranges.emplace_back(first, last);
        min = last + 1;
    }
    return ranges;
}

/// A fault of the file: the messages of the options do not fit.
void checkLook(const HeaderReader& reader, const AccumulationHeader& header) {
    try {
        parseExposure(header.exposure);
    } catch (const UsageError&) {
        reader.fail(fmt::format("has an invalid exposure: '{}'", header.exposure));
    }
    try {
        image::parseToneCurve(header.toneCurve);
    } catch (const UsageError&) {
        reader.fail(fmt::format("has an unknown tone curve: '{}'", header.toneCurve));
    }
}

template <typename T>
std::optional<std::string> difference(std::string_view name, const T& theirs, const T& ours) {
    if (theirs == ours) return std::nullopt;
    return fmt::format("{} is {}, not {}", name, theirs, ours);
}

std::string listOf(const std::vector<std::string>& layers) {
    return layers.empty() ? "beauty alone" : fmt::format("{}", fmt::join(layers, ","));
}

}  // namespace

std::string_view AccumulationHeader::value(std::string_view name) const {
    const auto found = std::find_if(identity.begin(), identity.end(),
                                    [&](const auto& entry) { return entry.first == name; });
    return found == identity.end() ? std::string_view() : std::string_view(found->second);
}

std::optional<std::string> firstDifference(const AccumulationHeader& theirs, const AccumulationHeader& ours) {
    const std::optional<std::string> differences[] = {
        difference("width", theirs.extent.width, ours.extent.width),
        difference("height", theirs.extent.height, ours.extent.height),
        difference("the number of frames", theirs.frames, ours.frames),
        difference("the number of samples", theirs.plan.samples, ours.plan.samples),
        difference("samples per launch", theirs.plan.launchSamples, ours.plan.launchSamples),
        difference("samples per block", theirs.plan.blockSamples, ours.plan.blockSamples),
        difference("the list of layers", listOf(theirs.layers), listOf(ours.layers)),
    };
    for (const auto& d : differences) {
        if (d) return d;
    }
    // Compared after the size and the number of frames, which the camera's hash depends on.
    for (const auto& [name, value] : ours.identity) {
        if (const auto d = difference(name, theirs.value(name), std::string_view(value))) return d;
    }
    if (theirs.identity.size() != ours.identity.size())
        return "it has settings that this version does not know";
    return std::nullopt;
}

std::optional<std::string> firstDifferenceOfLook(const AccumulationHeader& theirs,
                                                 const AccumulationHeader& ours) {
    if (const auto d = difference("--float", theirs.floatColors, ours.floatColors)) return d;
    if (const auto d = difference("--exposure", theirs.exposure, ours.exposure)) return d;
    return difference("--tone-curve", theirs.toneCurve, ours.toneCurve);
}

void warnOfOtherDevice(const std::filesystem::path& file, const AccumulationHeader& theirs,
                       const AccumulationHeader& ours) {
    if (theirs.device == ours.device && theirs.driver == ours.driver && theirs.tracer == ours.tracer) return;
    const auto describe = [](const AccumulationHeader& h) {
        return fmt::format("{} ({}, tracer {})", h.device, h.driver, h.tracer);
    };
    log::warn("{}: comes from {}, the rest from {}: right, but not bit for bit what one device gives",
              file.string(), describe(theirs), describe(ours));
}

uint64_t renderHash(const AccumulationHeader& header) {
    AccumulationHeader shared = header;
    shared.shard = {};
    shared.frame = 0;
    shared.finished.clear();
    shared.device.clear();
    shared.driver.clear();
    shared.tracer.clear();
    Hash64 hash;
    hash.add(toJson(shared));
    return hash.value();
}

std::string toJson(const AccumulationHeader& header) {
    Json identity = Json::array(), finished = Json::array();
    for (const auto& [name, value] : header.identity) identity.push_back({name, value});
    for (const auto& [first, last] : header.finished) {
        if (finished.size() < maxFinishedRanges) finished.push_back({first, last});
    }
    const Json json{{"identity", identity},
                    {"width", header.extent.width},
                    {"height", header.extent.height},
                    {"samples", header.plan.samples},
                    {"block_samples", header.plan.blockSamples},
                    {"launch_samples", header.plan.launchSamples},
                    {"layers", header.layers},
                    {"frames", header.frames},
                    {"shard", header.shard.index},
                    {"shards", header.shard.count},
                    {"frame", header.frame},
                    {"finished", finished},
                    {"device", header.device},
                    {"driver", header.driver},
                    {"tracer", header.tracer},
                    {"float", header.floatColors},
                    {"exposure", header.exposure},
                    {"tone_curve", header.toneCurve}};
    return json.dump();
}

AccumulationHeader headerFromJson(std::string_view text, const std::filesystem::path& file) {
    const HeaderReader reader(text, file);
    AccumulationHeader header;
    header.identity = readIdentity(reader);
    header.extent = extentOf(reader);
    header.plan = planOf(reader);
    header.layers = layersOf(reader);
    header.frames = reader.number("frames", 1, maxFrames);
    header.shard = shardOf(reader);
    header.frame = reader.number("frame", 0, header.frames - 1);
    if (header.frames > 1 && !header.shard.has(header.frame))
        reader.fail("is of a frame that its shard lacks");
    header.finished = finishedOf(reader, header.shard.countOf(header.frames));
    header.device = reader.text("device", reader.at("device"));
    header.driver = reader.text("driver", reader.at("driver"));
    header.tracer = reader.text("tracer", reader.at("tracer"));
    header.floatColors = reader.flag("float");
    header.exposure = reader.text("exposure", reader.at("exposure"));
    // Files of former versions have none.
    if (reader.has("tone_curve")) header.toneCurve = reader.text("tone_curve", reader.at("tone_curve"));
    checkLook(reader, header);
    return header;
}

}  // namespace limpid
