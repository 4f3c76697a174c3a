#include "base/files/frame_pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "base/error.h"

namespace limpid {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse(std::string_view text, std::string_view fault) {
    throw UsageError(fmt::format(
        "'{}': {} (a sequence has one %d or %0Nd, such as %04d, in the file's name; a percent sign is %%)",
        text, fault));
}

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

}  // namespace

FramePattern::FramePattern(std::string_view text) : text_(text) {
    for (size_t i = 0; i < text_.size(); ++i) {
        if (text_[i] != '%') {
            append(text_[i]);
        } else if (text_.substr(i, 2) == "%%") {
            append(text_[++i]);
        } else {
            i = parseNumber(i);
        }
    }
}

void FramePattern::append(char c) {
    if (numbered_ && c == '/') refuse(text_, "the frame number stands in the name of a folder");
    (numbered_ ? after_ : before_) += c;
}

/// `percent` is the position where a number should begin. Returns the position of its 'd'.
size_t FramePattern::parseNumber(size_t percent) {
    const size_t end = text_.find_first_not_of("0123456789", percent + 1);
    const std::string digits = text_.substr(percent + 1, end - percent - 1);
    const bool width = digits.size() == 2 && digits[0] == '0' && digits[1] != '0';
    if (end == std::string::npos || text_[end] != 'd' || !(digits.empty() || width)) {
        refuse(text_, fmt::format("'{}' is no frame number",
                                  text_.substr(percent, std::min(end, text_.size() - 1) - percent + 1)));
    }
    if (numbered_) refuse(text_, "it has more than one frame number");
    numbered_ = true;
    digits_ = width ? digits[1] - '0' : 0;
    return end;
}

fs::path FramePattern::format(int frame) const {
    if (frame < 0) throw Error(fmt::format("frame {} has no file name: frames count from 0", frame));
    if (!numbered_) return before_;
    return before_ + fmt::format("{:0{}}", frame, digits_) + after_;
}

std::optional<int> FramePattern::frameOf(std::string_view fileName) const {
    const std::string start = fs::path(before_).filename().string();
    if (!numbered_ || fileName.size() <= start.size() + after_.size()) return std::nullopt;
    const std::string_view number =
        fileName.substr(start.size(), fileName.size() - start.size() - after_.size());
    if (!std::all_of(number.begin(), number.end(), isDigit)) return std::nullopt;
    int frame = 0;
    if (std::from_chars(number.data(), number.data() + number.size(), frame).ec != std::errc{})
        return std::nullopt;
    // One rule for both directions: a name belongs to a frame if format() gives that name for it.
    if (format(frame).filename().string() != fileName) return std::nullopt;
    return frame;
}

std::vector<int> FramePattern::existingFrames() const {
    std::vector<int> frames;
    if (!numbered_) return frames;
    const fs::path parent = fs::path(before_).parent_path();
    const fs::path folder = parent.empty() ? fs::path(".") : parent;
    try {
        for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
            std::error_code ignored;
            if (entry.is_directory(ignored)) continue;
            if (const auto frame = frameOf(entry.path().filename().string())) frames.push_back(*frame);
        }
    } catch (const fs::filesystem_error& error) {
        throw InputError(
            text_, fmt::format("the folder {} cannot be read: {}", folder.string(), error.code().message()));
    }
    std::sort(frames.begin(), frames.end());
    return frames;
}

std::vector<int> FramePattern::wholeSequence() const {
    std::vector<int> frames = existingFrames();
    if (frames.empty()) throw InputError(text_, "there is no such file with any frame number");
    for (size_t i = 1; i < frames.size(); ++i) {
        if (frames[i] == frames[i - 1] + 1) continue;
        throw InputError(text_, "frame " + std::to_string(frames[i - 1] + 1) + " is missing: there are " +
                                    describeFrames(frames));
    }
    return frames;
}

std::string describeFrames(const std::vector<int>& frames) {
    std::string text;
    for (size_t first = 0, last = 0; first < frames.size(); first = ++last) {
        while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) ++last;
        if (!text.empty()) text += ", ";
        text += first == last ? fmt::format("{}", frames[first])
                              : fmt::format("{}-{}", frames[first], frames[last]);
    }
    return text;
}

}  // namespace limpid
