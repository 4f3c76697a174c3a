#include "shot/run/frame_reader.h"

#include <fmt/format.h>

#include "base/error.h"

namespace limpid::shot {

std::optional<LoadedFrame> FrameReader::read(size_t index, std::optional<size_t> next) {
    if (!reading_.valid() || ahead_ != index) start(index);
    std::future<LoadedFrame> current = std::move(reading_);
    std::optional<LoadedFrame> frame;
    try {
        frame = current.get();
        unpack(*frame, job_.load);
    } catch (const InputError& error) {
        const bool asked = index >= job_.firstAsked && index < job_.endAsked;
        if (asked && (!job_.skipUnreadable || job_.endAsked - job_.firstAsked == 1)) throw;
        frame.reset();
        if ((asked ? skipped_ : leftOut_).insert(job_.frames[index]).second)
            warn(job_, fmt::format("{}; {}", error.what(),
                                   asked ? "the frame is skipped" : "histories do without the frame"));
    }
    if (next) start(*next);
    return frame;
}

void FrameReader::start(size_t index) {
    ahead_ = index;
    reading_ = std::async(std::launch::async, [this, frame = job_.frames[index]] {
        return loadFrame(inputOf(job_, frame), frame, job_.load);
    });
}

}  // namespace limpid::shot
