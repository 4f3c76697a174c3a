// The C interface for shots of any renderer (limpid/shot.h).
#include "base/log.h"
#include "denoise/api/c_device.h"
#include "denoise/api/c_guard.h"
#include "limpid/shot.h"
#include "renderer/method/network_file.h"
#include "shot/run/denoise_shot.h"
#include "shot/run/explain_shot.h"
#include "shot/run/shot_request.h"

using namespace limpid;
using namespace limpid::denoise;

namespace {

/// Leaves the default if there is no text.
void read(const char* text, std::string& value) {
    if (text) value = text;
}

std::vector<std::string> listOf(const limpid_texts& texts, const char* name) {
    if (texts.count > 0) required(texts.data, name);
    std::vector<std::string> list;
    for (size_t i = 0; i < texts.count; ++i) list.emplace_back(&required(texts.data[i], name));
    return list;
}

shot::ShotRequest requestOf(const limpid_shot_desc& d) {
    shot::ShotRequest request;
    request.input = &required(d.input, "limpid_shot_desc::input");
    read(d.output, request.output);
    read(d.denoiser, request.denoiser);
    read(d.preset, request.preset);
    request.settings = listOf(d.settings, "limpid_shot_desc::settings");
    read(d.weights, request.weights);
    request.map = listOf(d.map, "limpid_shot_desc::map");
    read(d.map_file, request.mapFile);
    request.files = listOf(d.files, "limpid_shot_desc::files");
    read(d.cameras, request.cameras);
    if (d.fps != 0.0f) request.cameraTiming.framesPerSecond = d.fps;
    request.cameraTiming.firstFrame = d.camera_start;
    read(d.motion, request.motion);
    read(d.frames, request.frames);
    read(d.shard, request.shard);
    read(d.cuts, request.cuts);
    read(d.on_error, request.onError);
    read(d.exposure, request.exposure);
    if (d.strength != 0.0f) request.strength = d.strength;
    request.preserve = d.preserve;
    read(d.recover, request.recover);
    request.bidirectional = d.bidirectional != 0;
    request.resume = d.resume != 0;
    return request;
}

/// The library prints nothing. (What tells of files on stderr in the program is not lost: it fails or is in
/// the shot's messages.)
void silenceLog() {
    static const bool once = [] {
        log::setLevel(log::Level::Error);
        return true;
    }();
    static_cast<void>(once);
}

/// Copies as much of the summary as the caller's version has.
void give(const shot::ShotSummary& result, limpid_shot_summary* summary) {
    if (!summary) return;
    limpid_shot_summary whole = wholeStruct(summary, "limpid_shot_summary");
    whole.frames = static_cast<uint32_t>(result.frames);
    whole.kept = static_cast<uint32_t>(result.kept);
    whole.skipped = static_cast<uint32_t>(result.skipped.size());
    whole.cuts = static_cast<uint32_t>(result.cuts.size());
    whole.stopped = result.stopped ? 1 : 0;
    whole.seconds = result.seconds;
    std::memcpy(summary, &whole, std::min(summary->size, sizeof whole));
}

void denoiseShot(const limpid_device_desc* on, const limpid_shot_desc& desc, limpid_shot_summary* summary) {
    silenceLog();
    if (summary) wholeStruct(summary, "limpid_shot_summary");  // before hours of work
    const shot::ShotRequest request = requestOf(desc);
    if (request.output.empty()) throw UsageError("limpid_shot_desc::output is NULL");
    shot::ShotJob job = shot::jobOf(request);
    const std::shared_ptr<gpu::Device> device = openDevice(on);
    job.options.networks = loadNetworks(*device, job.options.method, job.weights, job.options.settings);
    if (on) {
        const limpid_device_desc whole = wholeStruct(on, "limpid_device_desc");
        job.messages = callbackOf(whole.message, whole.message_user);
    }
    if (desc.progress)
        job.progress = [&desc](size_t done, size_t total) {
            return desc.progress(desc.progress_user, static_cast<uint32_t>(done),
                                 static_cast<uint32_t>(total)) == 0;
        };
    give(shot::denoiseShot(job, *device), summary);
}

}  // namespace

extern "C" {

uint32_t limpid_shot_version(void) {
    return 10000 * LIMPID_VERSION_MAJOR + 100 * LIMPID_VERSION_MINOR + LIMPID_VERSION_PATCH;
}

const char* limpid_shot_last_error(void) {
    return lastErrorText();
}

limpid_result limpid_shot_denoise(const limpid_device_desc* device, const limpid_shot_desc* shot,
                                  limpid_shot_summary* summary) {
    return guarded([&] { denoiseShot(device, wholeStruct(shot, "limpid_shot_desc"), summary); });
}

limpid_result limpid_shot_explain(const limpid_shot_desc* shot, void (*text)(void* user, const char* text),
                                  void* user) {
    return guarded([&] {
        silenceLog();
        required(text, "text");
        shot::ShotRequest request = requestOf(wholeStruct(shot, "limpid_shot_desc"));
        request.output.clear();
        text(user, shot::explainShot(shot::jobOf(request)).c_str());
    });
}

}  // extern "C"
