// Names of numbered files: "out/frame.%04d.exr" is out/frame.0007.exr at frame 7.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limpid {

/// A file name with a placeholder for the frame number in its last component: %d (plain) or %0Nd (at least N
/// digits, N from 1 to 9, padded with zeros). %% stands for a percent sign. A name without a placeholder
/// names the same file at every frame.
class FramePattern {
  public:
    /// Throws UsageError, naming `text`, if it has any other use of %, more than one placeholder, or a
    /// placeholder in a folder's name.
    explicit FramePattern(std::string_view text);

    /// True if the name contains a frame number: it names a sequence of files.
    bool numbered() const { return numbered_; }

    /// Returns the file name of this frame. Throws Error if `frame` < 0. Ignores `frame` if the pattern has
    /// no number.
    std::filesystem::path format(int frame) const;

    /// Returns the frame whose file has this name (without folders); none if the pattern has no number or
    /// never produces this name ("a.12.exr" is no frame of "a.%04d.exr").
    std::optional<int> frameOf(std::string_view fileName) const;

    /// Returns the frames whose files exist, ascending; empty if there are none or the pattern has no number.
    /// Throws InputError if the folder cannot be read.
    std::vector<int> existingFrames() const;

    /// Like existingFrames(), but throws InputError if there are no frames or there are gaps between them.
    std::vector<int> wholeSequence() const;

    /// The pattern as the user wrote it.
    const std::string& text() const { return text_; }

  private:
    void append(char c);
    size_t parseNumber(size_t percent);

    std::string text_;
    std::string before_, after_;  ///< text before (with folders) and after the number, %% resolved
    int digits_ = 0;              ///< minimum length of the number; 0: no padding
    bool numbered_ = false;
};

/// Formats frame numbers (ascending) for a message: "1-4, 7, 9-10".
std::string describeFrames(const std::vector<int>& frames);

}  // namespace limpid
