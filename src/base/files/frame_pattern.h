// Names of numbered files: "out/frame.%04d.exr" is out/frame.0007.exr at frame 7.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace limpid {

/// A file name as a user writes it, in which one %d (plain) or %0Nd (at least N digits, N from 1 to 9, filled
/// with zeros) in the last component stands for the frame number, and %% for a percent sign. A name without a
/// number names the same file at every frame.
class FramePattern {
  public:
    /// Throws UsageError, naming `text`, if it holds any other use of %, more than one number, or a number in
    /// a folder's name.
    explicit FramePattern(std::string_view text);

    /// Whether a frame number is part of the name: a sequence of files, not one file.
    bool numbered() const { return numbered_; }

    /// The name of this frame's file. `frame` >= 0, else Error; ignored where the pattern has no number.
    std::filesystem::path format(int frame) const;

    /// The frame whose file has this name (without folders); none if the pattern has no number or never gives
    /// this name ("a.12.exr" is no frame of "a.%04d.exr").
    std::optional<int> frameOf(std::string_view fileName) const;

    /// The frames whose files exist, ascending; empty if there are none or the pattern has no number. Throws
    /// InputError if the folder cannot be read.
    std::vector<int> existingFrames() const;

    /// The same, for whoever needs them all: throws InputError if there are none or some are missing in
    /// between.
    std::vector<int> wholeSequence() const;

    /// The pattern as the user wrote it.
    const std::string& text() const { return text_; }

  private:
    void append(char c);
    size_t parseNumber(size_t percent);

    std::string text_;
    std::string before_, after_;  ///< what stands before (with folders) and after the number, %% resolved
    int digits_ = 0;              ///< the number's least length; 0: as long as it needs
    bool numbered_ = false;
};

/// Frame numbers (ascending) for a message: "1-4, 7, 9-10".
std::string describeFrames(const std::vector<int>& frames);

}  // namespace limpid
