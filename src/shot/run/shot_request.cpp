#include "shot/run/shot_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "renderer/layers/picture_name.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"

namespace limpid::shot {
namespace {

namespace fs = std::filesystem;

/// Returns the request's denoiser, else that of its preset, else svgf.
const denoise::Denoiser& chosenDenoiser(const ShotRequest& r) {
    const std::string name = r.denoiser.empty() && r.preset.empty() ? "svgf" : r.denoiser;
    const Pipeline pipeline = pipelineFor(r.preset, {.integrator = {}, .denoiser = name}, {});
    if (!pipeline.denoiser)
        throw UsageError(
            fmt::format("--denoiser is missing; it is one of {}", fmt::join(denoiserNames(), ", ")));
    for (const std::string& text : r.settings)
        checkTakesPart(pipeline.denoiser->groups, text, pipeline.denoiser->name);
    return *pipeline.denoiser;
}

denoise::DenoiserSettings settingsOf(const ShotRequest& r) {
    RenderSettings settings;
    applyPreset(settings, r.preset);
    for (const std::string& text : r.settings) assign(settings, text);
    return settings.denoisers;
}

uint64_t hashOfFile(const std::string& path) {
    Hash64 hash;
    hash.add(readFile(path));
    return hash.value();
}

/// Parses "10-20" or "7".
std::pair<int, int> parseRange(const std::string& text) {
    int first = 0, last = 0;
    const char* const end = text.data() + text.size();
    const auto a = std::from_chars(text.data(), end, first);
    bool good = a.ec == std::errc{} && first >= 0;
    last = first;
    if (good && a.ptr != end) {
        const auto b = std::from_chars(a.ptr + 1, end, last);
        good = *a.ptr == '-' && b.ec == std::errc{} && b.ptr == end && last >= first;
    }
    if (!good) throw UsageError(fmt::format("--frames {}: an example is 10-20", text));
    return {first, last};
}

/// Returns the frames to denoise, or -1 for a single file.
std::vector<int> framesOf(const ShotRequest& r, const FramePattern& input) {
    if (!input.numbered()) {
        if (!r.frames.empty()) throw UsageError("--frames: the input's name holds no number");
        return {-1};
    }
    const bool skips = r.onError == "skip";
    std::vector<int> frames = skips ? input.existingFrames() : std::vector<int>{};
    if (r.frames.empty()) return frames.empty() ? input.wholeSequence() : frames;
    if (frames.empty()) frames = input.existingFrames();
    const auto [first, last] = parseRange(r.frames);
    std::erase_if(frames, [&, a = first, b = last](int frame) { return frame < a || frame > b; });
    for (size_t i = 0; !skips && i + 1 < frames.size(); ++i)
        if (frames[i + 1] != frames[i] + 1)
            throw InputError(input.text(), fmt::format("frame {} is missing", frames[i] + 1));
    if (frames.empty()) throw InputError(input.text(), fmt::format("there are no frames {}", r.frames));
    if (!skips && (frames.front() != first || frames.back() != last))
        throw InputError(input.text(),
                         fmt::format("frame {} is missing", frames.front() != first ? first : last));
    return frames;
}

/// Chooses the job's frames that are written: all, or those of "2/4", the second of four parts.
void chooseShard(const std::string& text, ShotJob& job) {
    size_t part = 1, parts = 1;
    if (!text.empty()) {
        const char* const end = text.data() + text.size();
        const auto a = std::from_chars(text.data(), end, part);
        const auto b = a.ptr < end && *a.ptr == '/' ? std::from_chars(a.ptr + 1, end, parts) : a;
        if (a.ec != std::errc{} || b.ec != std::errc{} || b.ptr != end || b.ptr == a.ptr || part < 1 ||
            part > parts)
            throw UsageError(fmt::format("--shard {}: an example is 2/4, the second of four parts", text));
    }
    const size_t count = job.frames.size();
    job.firstWritten = count * (part - 1) / parts;
    job.endWritten = count * part / parts;
}

/// What the result depends on besides the input.
std::string settingsText(const ShotRequest& r) {
    const auto hashed = [](const std::string& file) {
        return file.empty() ? std::string() : hashText(hashOfFile(file));
    };
    return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {}", LIMPID_VERSION, r.denoiser, r.preset,
                       hashed(r.weights), fmt::join(r.settings, " "), fmt::join(r.map, " "),
                       fmt::join(r.files, " "), hashed(r.mapFile), r.cuts, r.motion, r.bidirectional,
                       r.strength, r.preserve);
}

/// Parses "auto", "none" or "12,40".
std::optional<std::vector<int>> parseCuts(const std::string& text) {
    if (text == "auto") return std::nullopt;
    std::vector<int> cuts;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (text != "none" && at < end) {
        int frame = 0;
        const auto [next, error] = std::from_chars(at, end, frame);
        if (error != std::errc{} || (next != end && *next != ','))
            throw UsageError(fmt::format("--cuts {}: it is auto, none, or frames separated by commas", text));
        cuts.push_back(frame);
        at = next + 1;
    }
    return cuts;
}

Assignments mapOf(const ShotRequest& r) {
    Assignments result;
    if (!r.mapFile.empty()) result = readAssignments(r.mapFile);
    for (const std::string& text : r.map) result.push_back(parseAssignment(text));
    return result;
}

std::vector<std::pair<std::string, FramePattern>> filesOf(const ShotRequest& r, bool numbered) {
    std::vector<std::pair<std::string, FramePattern>> files;
    for (const std::string& text : r.files) {
        const size_t equals = text.find('=');
        if (equals == 0 || equals == std::string::npos)
            throw UsageError(fmt::format("--file {}: an example is albedo=albedo.%04d.pfm", text));
        files.emplace_back(text.substr(0, equals), FramePattern(text.substr(equals + 1)));
        if (files.back().second.numbered() && !numbered)
            throw UsageError(fmt::format("--file {}: the input's name holds no number", text));
    }
    return files;
}

void chooseMethod(const ShotRequest& r, ShotJob& job) {
    job.options.method = &chosenDenoiser(r);
    if (job.options.method->oneChannel)
        throw UsageError(fmt::format("--denoiser {} filters one channel, and files have colours",
                                     job.options.method->name));
    job.options.settings = settingsOf(r);
    job.options.keepsAntialiasing =
        !r.preset.empty() || std::any_of(r.settings.begin(), r.settings.end(),
                                         [](const std::string& text) { return text.starts_with("taa."); });
    job.weights = r.weights;
    job.bidirectional = r.bidirectional && job.input.numbered();
    if (job.bidirectional && (job.options.method->network || job.options.method->name == "bilateral"))
        throw UsageError(
            fmt::format("--bidirectional: --denoiser {} has no history", job.options.method->name));
}

void addCameras(const ShotRequest& r, ShotJob& job) {
    if (r.cameras.empty()) return;
    const float fps = r.cameraTiming.framesPerSecond;
    if (!(fps >= 1e-3f && fps <= 1e6f))
        throw UsageError(fmt::format("--fps {}: it is from 0.001 to 1e6", fps));
    if (std::abs(static_cast<int64_t>(r.cameraTiming.firstFrame)) > 1000000000)
        throw UsageError("--camera-start is from -1e9 to 1e9");
    auto cameras = std::make_shared<const CameraTrack>(CameraTrack::read(r.cameras, r.cameraTiming));
    job.settingsText += " " + hashText(cameras->hash());
    const std::vector<int> lacking = job.input.numbered() ? cameras->lacking(job.frames) : std::vector<int>{};
    if (!lacking.empty()) {
        const char* const text =
            cameras->ofAnimation()
                ? "{}: its animation does not reach frames {}; the camera stands still there "
                  "(--fps, --camera-start)"
                : "{} has no camera for frames {}";
        job.warnings.push_back(fmt::format(fmt::runtime(text), r.cameras, describeFrames(lacking)));
    }
    job.options.cameras = std::move(cameras);
}

void chooseFrames(const ShotRequest& r, ShotJob& job) {
    const auto cuts = parseCuts(r.cuts);
    job.cuts = cuts ? Cuts::Given : Cuts::Found;
    job.cutFrames = cuts.value_or(std::vector<int>{});
    if (r.onError != "stop" && r.onError != "skip") throw UsageError("--on-error is 'stop' or 'skip'");
    job.skipUnreadable = r.onError == "skip";
    job.frames = framesOf(r, job.input);
    chooseShard(r.shard, job);
    job.resume = r.resume;
}

/// A name by which equal files can be found, whether they exist or not.
fs::path wholePath(const fs::path& path) {
    const fs::path target = fs::absolute(linkTarget(path));
    std::error_code fault;
    const fs::path whole = fs::weakly_canonical(target, fault);
    return fault ? target.lexically_normal() : whole;
}

/// The numbers of a pattern's files that the job reads, and of those that exist: they may be frames of the
/// shot that the job leaves out.
std::set<int> sourcesOf(const FramePattern& pattern, const ShotJob& job) {
    std::set<int> frames(job.frames.begin(), job.frames.end());
    try {
        for (const int frame : pattern.existingFrames()) frames.insert(frame);
    } catch (const InputError&) {
        // The folder cannot be read: whoever reads the files will say so.
    }
    return frames;
}

/// True if a file of the pattern is an output, perhaps of another frame: "a.1%d.exr" of frame 2 is "a.%d.exr"
/// of frame 12.
bool isReplaced(const FramePattern& pattern, const std::set<fs::path>& outputs, const ShotJob& job) {
    const auto isOutput = [&](int frame) {
        const fs::path file = pattern.format(std::max(frame, 0));
        const bool written = std::binary_search(job.frames.begin(), job.frames.end(), frame);
        try {
            // isSameFile() also knows hard links.
            return outputs.contains(wholePath(file)) || (written && isSameFile(file, outputOf(job, frame)));
        } catch (const std::runtime_error&) {
            return false;  // a link that leads to no file, and so to no output
        }
    };
    return std::ranges::any_of(sourcesOf(pattern, job), isOutput);
}

/// Throws UsageError if an output is a file that this job or another one of the same shot reads.
void refuseReplacing(const ShotRequest& r, const ShotJob& job) {
    std::set<fs::path> outputs;
    for (const int frame : job.frames) outputs.insert(wholePath(outputOf(job, frame)));
    if (isReplaced(job.input, outputs, job)) throw UsageError("'" + r.output + "': the output is the input");
    for (const auto& [name, pattern] : job.load.files) {
        if (isReplaced(pattern, outputs, job))
            throw UsageError(fmt::format("'{}': the output is the file of --file {}", r.output, name));
    }
}

void checkFiles(const ShotRequest& r, const ShotJob& job) {
    if (r.output.empty()) return;
    if (job.input.numbered() != job.output.numbered())
        throw UsageError("'" + r.output + "': the output's name holds a number if the input's does");
    if (r.resume && !isExr(job.output.format(0)))
        throw UsageError("--resume: only EXR files tell what they are of");
    refuseReplacing(r, job);
}

}  // namespace

ShotJob jobOf(const ShotRequest& r) {
    ShotJob job{.input = FramePattern(r.input),
                .output = FramePattern(r.output.empty() ? r.input : r.output)};
    job.exposure = parseExposure(r.exposure);
    if (!r.output.empty()) checkPictureOutput(job.output.format(0));
    if (!(r.strength >= 0.0f && r.strength <= 1.0f)) throw UsageError("--strength is from 0 to 1");
    job.strength = r.strength;
    if (!(r.preserve >= 0.0f && r.preserve <= 1.0f)) throw UsageError("--preserve is from 0 to 1");
    job.preserve = r.preserve;
    chooseMethod(r, job);
    chooseFrames(r, job);
    job.load.assignments = mapOf(r);
    job.load.network = job.options.method->network;
    job.load.files = filesOf(r, job.input.numbered());
    if (r.motion != "auto" && r.motion != "none") throw UsageError("--motion is 'auto' or 'none'");
    job.load.searchMotion = r.motion == "auto";
    job.load.sequence = job.frames.size() > 1;
    job.settingsText = settingsText(r);
    addCameras(r, job);
    checkFiles(r, job);
    return job;
}

}  // namespace limpid::shot
