#include "cli/denoise_windows.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/error.h"
#include "base/hash.h"
#include "cli/cluster/cluster_progress.h"
#include "cli/cluster/session.h"
#include "cli/console/interrupt.h"

namespace limpid::cli {
namespace {

using nlohmann::json;
using shot::ShotSummary;

/// Backward blocks of bidirectional shots, which are as long, then begin where they do in one run.
constexpr size_t defaultWindow = shot::blockFrames;

void addTo(ShotSummary& sum, const ShotSummary& part) {
    sum.frames += part.frames;
    sum.kept += part.kept;
    sum.stopped = sum.stopped || part.stopped;
    // Run-ups tell of frames of other windows again.
    const auto unite = [](std::vector<int>& all, const std::vector<int>& added) {
        all.insert(all.end(), added.begin(), added.end());
        std::ranges::sort(all);
        all.erase(std::unique(all.begin(), all.end()), all.end());
    };
    unite(sum.skipped, part.skipped);
    unite(sum.cuts, part.cuts);
}

cluster::Bytes encode(const ShotSummary& summary) {
    const std::string text = json{
        {"frames", summary.frames},
        {"kept", summary.kept},
        {"stopped", summary.stopped},
        {"skipped", summary.skipped},
        {"cuts", summary.cuts}}.dump();
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

ShotSummary decode(cluster::BytesView bytes) {
    const auto* const begin = reinterpret_cast<const char*>(bytes.data());
    const json object = json::parse(begin, begin + bytes.size());
    ShotSummary summary;
    object.at("frames").get_to(summary.frames);
    object.at("kept").get_to(summary.kept);
    object.at("stopped").get_to(summary.stopped);
    object.at("skipped").get_to(summary.skipped);
    object.at("cuts").get_to(summary.cuts);
    return summary;
}

uint64_t identityOf(const shot::ShotJob& job, size_t window) {
    Hash64 hash;
    hash.add(job.settingsText);
    hash.add(job.input.text() + '\n' + job.output.text());
    hash.addValue(window);
    for (const int frame : job.frames) hash.addValue(frame);
    hash.addValue(job.firstWritten);
    hash.addValue(job.endWritten);
    return hash.value();
}

/// The windows of a shot, and what has come of those that this process made.
class Windows {
  public:
    Windows(const shot::ShotJob& job, size_t length, gpu::Device& device)
        : job_(job), length_(length), device_(device) {}

    uint64_t count() const { return (job_.endWritten - job_.firstWritten + length_ - 1) / length_; }
    uint64_t framesUpTo(uint64_t window) const {
        return std::min<uint64_t>(window * length_, job_.endWritten - job_.firstWritten);
    }
    /// Returns false if the user has stopped it.
    bool denoise(uint64_t window) {
        shot::ShotJob part = job_;
        part.firstWritten = job_.firstWritten + framesUpTo(window);
        part.endWritten = job_.firstWritten + framesUpTo(window + 1);
        const ShotSummary made = shot::denoiseShot(part, device_);
        addTo(summary, made);
        return !made.stopped;
    }

    ShotSummary summary;

  private:
    const shot::ShotJob& job_;
    size_t length_;
    gpu::Device& device_;
};

ShotSummary denoiseAlone(shot::ShotJob& job, size_t length, gpu::Device& device) {
    Windows windows(job, length, device);
    Progress progress("frames", job.endWritten - job.firstWritten);
    uint64_t before = 0;
    // A warning about all frames comes from every window.
    std::set<std::string> said;
    job.messages = [&, show = job.messages](MessageLevel level, const std::string& text) {
        if (show && said.insert(text).second) show(level, text);
    };
    job.progress = [&](size_t done, size_t) {
        progress.show(before + done);
        return !interrupted();
    };
    for (uint64_t window = 0; window < windows.count(); ++window) {
        before = windows.framesUpTo(window);
        if (!windows.denoise(window)) break;
    }
    return windows.summary;
}

ShotSummary denoiseShared(shot::ShotJob& job, size_t length, gpu::Device& device,
                          std::vector<uint64_t>& madeByProcess) {
    Windows windows(job, length, device);
    ClusterProgress progress("windows", windows.count());
    job.progress = [](size_t, size_t) {
        ranks()->beat();
        return !interrupted();
    };
    cluster::SharedWork work;
    work.identity = identityOf(job, length);
    work.device = device.info().name + ", " + device.info().driver;
    for (uint64_t window = 0; window < windows.count(); ++window) work.todo.push_back(window);
    work.make = [&](uint64_t window) { return windows.denoise(window); };
    work.farewell = [&] { return encode(windows.summary); };
    ShotSummary others;
    work.addFarewell = [&](cluster::BytesView bytes) { addTo(others, decode(bytes)); };
    work.finished = [&](const std::vector<uint64_t>&, uint64_t count) { progress.show(count); };
    madeByProcess = ranks()->share(work);
    addTo(others, windows.summary);
    return others;
}

}  // namespace

ShotSummary denoiseInWindows(shot::ShotJob& job, size_t windowFrames, gpu::Device& device,
                             std::vector<uint64_t>& madeByProcess) {
    const auto start = std::chrono::steady_clock::now();
    const size_t whole = std::max<size_t>(job.endWritten - job.firstWritten, 1);
    const size_t length = windowFrames > 0 ? windowFrames : ranks() ? defaultWindow : whole;
    ShotSummary summary =
        ranks() ? denoiseShared(job, length, device, madeByProcess) : denoiseAlone(job, length, device);
    summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (isFirstProcess()) shot::checkSomeFrameWasRead(job, summary);  // others know their windows alone
    return summary;
}

}  // namespace limpid::cli
