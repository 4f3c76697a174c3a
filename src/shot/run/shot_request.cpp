#include "shot/run/shot_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
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

/// Forgets the frames before index `from`, and from index `to` on. Those asked for must be between.
void keepFrames(size_t from, size_t to, ShotJob& job) {
    job.frames = {job.frames.begin() + static_cast<ptrdiff_t>(from),
                  job.frames.begin() + static_cast<ptrdiff_t>(to)};
    for (size_t* const index : {&job.firstAsked, &job.endAsked, &job.firstWritten, &job.endWritten})
        *index -= std::min(*index, from);
}

/// The frames that the user asks for.
std::span<const int> askedFrames(const ShotJob& job) {
    return std::span(job.frames).subspan(job.firstAsked, job.endAsked - job.firstAsked);
}

/// Names the frames from `first` to `last` that are not among `frames`, which are ascending: "frames 3, 7-9
/// are missing". "" if there are none.
std::string describeMissing(std::span<const int> frames, int first, int last) {
    constexpr size_t shown = 20;
    std::string text;
    size_t gaps = 0;
    int64_t missing = 0, next = first;
    const auto addGap = [&](int64_t end) {
        if (end <= next) return;
        missing += end - next;
        if (++gaps > shown) return;
        text += fmt::format("{}{}", gaps > 1 ? ", " : "", next);
        if (end > next + 1) text += fmt::format("-{}", end - 1);
    };
    for (const int frame : frames) {
        addGap(frame);
        next = int64_t{frame} + 1;
    }
    addGap(int64_t{last} + 1);
    if (gaps == 0) return {};
    if (gaps > shown) text += fmt::format(" and others ({} in all)", missing);
    return missing == 1 ? fmt::format("frame {} is missing", text)
                        : fmt::format("frames {} are missing", text);
}

/// Keeps only those frames around the ones that are asked for that can make histories for them: those without
/// a gap between, and not too many. They are kept in both directions, for --bidirectional.
void limitRunUps(ShotJob& job) {
    std::vector<int>& frames = job.frames;
    size_t from = job.firstAsked, to = job.endAsked;
    while (from > 0 && job.firstAsked - from < runUpFrames && frames[from - 1] + 1 == frames[from]) --from;
    while (to < frames.size() && to - job.endAsked < runUpFrames && frames[to - 1] + 1 == frames[to]) ++to;
    keepFrames(from, to, job);
}

/// Finds the frames that exist, and which of them are asked for. A single file is frame -1.
void findFrames(const ShotRequest& r, ShotJob& job) {
    const FramePattern& input = job.input;
    if (!input.numbered()) {
        if (!r.frames.empty()) throw UsageError("--frames: the input's name holds no number");
        job.frames = {-1};
        job.endAsked = 1;
        return;
    }
    const bool all = r.frames.empty();
    std::vector<int>& frames = job.frames;
    if (job.skipUnreadable || !all) frames = input.existingFrames();
    if (all && frames.empty()) frames = input.wholeSequence();
    const auto [first, last] = all ? std::pair(frames.front(), frames.back()) : parseRange(r.frames);
    const auto begin = std::ranges::lower_bound(frames, first), end = std::ranges::upper_bound(frames, last);
    if (begin == end) throw InputError(input.text(), fmt::format("there are no frames {}", r.frames));
    const std::string missing = describeMissing({begin, end}, first, last);
    if (!missing.empty() && !job.skipUnreadable) throw InputError(input.text(), missing);
    if (!missing.empty()) job.warnings.push_back(fmt::format("{}: {}", input.text(), missing));
    job.firstAsked = static_cast<size_t>(begin - frames.begin());
    job.endAsked = static_cast<size_t>(end - frames.begin());
    limitRunUps(job);
}

/// Chooses the frames that are written: all that are asked for, or those of "2/4", the second of four parts.
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
    const size_t count = job.endAsked - job.firstAsked;
    job.firstWritten = job.firstAsked + count * (part - 1) / parts;
    job.endWritten = job.firstAsked + count * part / parts;
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

/// Given cameras and others are in different spaces, so frames without one would spoil the histories of those
/// that are asked for.
void limitRunUpsToCameras(const CameraTrack& cameras, ShotJob& job) {
    const auto has = [&](size_t index) { return cameras.lacking({&job.frames[index], 1}).empty(); };
    size_t from = job.firstAsked, to = job.endAsked;
    while (from > 0 && has(from - 1)) --from;
    while (to < job.frames.size() && has(to)) ++to;
    keepFrames(from, to, job);
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
    const std::vector<int> lacking =
        job.input.numbered() ? cameras->lacking(askedFrames(job)) : std::vector<int>{};
    if (!lacking.empty()) {
        const char* const text =
            cameras->ofAnimation()
                ? "{}: its animation does not reach frames {}; the camera stands still there "
                  "(--fps, --camera-start)"
                : "{} has no camera for frames {}";
        job.warnings.push_back(fmt::format(fmt::runtime(text), r.cameras, describeFrames(lacking)));
    }
    limitRunUpsToCameras(*cameras, job);
    job.load.givesCameras = true;
    job.options.cameras = std::move(cameras);
}

void chooseFrames(const ShotRequest& r, ShotJob& job) {
    const auto cuts = parseCuts(r.cuts);
    job.cuts = cuts ? Cuts::Given : Cuts::Found;
    job.cutFrames = cuts.value_or(std::vector<int>{});
    if (r.onError != "stop" && r.onError != "skip") throw UsageError("--on-error is 'stop' or 'skip'");
    job.skipUnreadable = r.onError == "skip";
    findFrames(r, job);
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
        const bool written = std::ranges::binary_search(askedFrames(job), frame);
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
    for (const int frame : askedFrames(job)) outputs.insert(wholePath(outputOf(job, frame)));
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
    job.settingsText = settingsText(r);
    addCameras(r, job);
    job.load.sequence = job.frames.size() > 1;  // also if one of them is asked for
    checkFiles(r, job);
    return job;
}

}  // namespace limpid::shot
