#include "shot/run/frame_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "base/error.h"

namespace limpid::shot {
namespace {

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

}  // namespace

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

std::span<const int> askedFrames(const ShotJob& job) {
    return std::span(job.frames).subspan(job.firstAsked, job.endAsked - job.firstAsked);
}

void limitRunUpsToCameras(const CameraTrack& cameras, ShotJob& job) {
    const auto has = [&](size_t index) { return cameras.lacking({&job.frames[index], 1}).empty(); };
    size_t from = job.firstAsked, to = job.endAsked;
    while (from > 0 && has(from - 1)) --from;
    while (to < job.frames.size() && has(to)) ++to;
    keepFrames(from, to, job);
}

}  // namespace limpid::shot
