// Moving pictures: frames piped to the program ffmpeg, which Limpid runs where it is installed and never
// links.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "image/image.h"
#include "image/io/png/png.h"
#include "image/tone_curve.h"

namespace limpid::cli {

/// Whether an output of this name is a clip: .mp4, .webm, .webp or .gif.
bool isClip(const std::filesystem::path& path);

/// Throws Error, naming the Debian package, if there is no ffmpeg to run; OutputError if the file cannot be
/// written.
void checkClipOutput(const std::filesystem::path& path);

struct ClipFormat {
    uint32_t width = 0, height = 0;
    double framesPerSecond = 30.0;
    image::ToneCurve toneCurve = image::ToneCurve::Standard;
    std::optional<float> stops;  ///< exposure; none: what the first frame calls for, for all
    bool shownAsIs = false;      ///< values are shares in [0,1], no radiance
};

class ClipWriter {
  public:
    /// Starts ffmpeg, which writes `file`; what that is follows from its name. Throws Error if it cannot be
    /// started. Until the writer is gone, the signals that interrupt a program remove `file` before they end
    /// it.
    ClipWriter(const std::filesystem::path& file, const ClipFormat& format);
    /// Stops ffmpeg if the clip is not finished.
    ~ClipWriter();
    ClipWriter(const ClipWriter&) = delete;
    ClipWriter& operator=(const ClipWriter&) = delete;

    /// The next frame, linear radiance, of the format's size. `subject`: of each pixel, the share of its
    /// samples that met a surface, which automatic exposure is measured on; may be empty. Throws Error with
    /// ffmpeg's last words if it has failed.
    void add(const image::Image& beauty, std::span<const float> subject);
    /// To be called once, after the last frame. Throws as add() does.
    void finish();
    /// No frame was added: what ffmpeg makes of none is no clip.
    bool isEmpty() const { return isEmpty_; }

  private:
    void start(const std::filesystem::path& file);
    void send(const image::ByteImage& frame);
    [[noreturn]] void fail(int status) const;
    std::string lastWords() const;
    int wait();

    ClipFormat format_;
    bool evenSize_;  ///< a row or column more where there would be an odd number
    bool isEmpty_ = true;
    pid_t process_ = -1;
    int input_ = -1, faults_ = -1;
};

}  // namespace limpid::cli
