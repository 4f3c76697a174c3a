#include "shot/run/shot_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/files/file.h"
#include "base/hash.h"
#include "renderer/layers/picture_name.h"
#include "renderer/method/parameters.h"
#include "renderer/method/presets.h"
#include "shot/run/frame_choice.h"
#include "shot/run/output_check.h"

namespace limpid::shot {
namespace {

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

/// What the result depends on besides the input.
std::string settingsText(const ShotRequest& r) {
    const auto hashed = [](const std::string& file) {
        return file.empty() ? std::string() : hashText(hashOfFile(file));
    };
    return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {}", LIMPID_VERSION, r.denoiser, r.preset,
                       hashed(r.weights), fmt::join(r.settings, " "), fmt::join(r.map, " "),
                       fmt::join(r.files, " "), hashed(r.mapFile), r.cuts, r.motion, r.bidirectional,
                       r.strength, r.preserve, r.recover);
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
    if (job.bidirectional && !job.options.method->keepsHistory)
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
    job.options.cameras = std::move(cameras);
}

/// A preset is what its paper says, and no more.
Recover recoverOf(const std::string& text, bool preset) {
    if (text == "auto") return preset ? Recover::Off : Recover::Auto;
    if (text != "on" && text != "off") throw UsageError("--recover is 'auto', 'on' or 'off'");
    return text == "on" ? Recover::On : Recover::Off;
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
    job.options.recover = recoverOf(r.recover, !r.preset.empty());
    chooseMethod(r, job);
    chooseFrames(r, job);
    job.load.assignments = mapOf(r);
    job.load.network = job.options.method->network;
    job.load.variances = job.options.method->readsVariances;
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
