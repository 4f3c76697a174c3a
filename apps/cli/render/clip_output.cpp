#include "cli/render/clip_output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <vector>

#include "base/error.h"
#include "base/files/file.h"
#include "cli/console/interrupt.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"

extern char** environ;

namespace limpid::cli {

namespace fs = std::filesystem;

namespace {

struct Kind {
    const char* extension;
    const char* container;             ///< its name in ffmpeg
    bool evenSize;                     ///< chroma is stored per 2x2 pixels
    std::vector<std::string> options;  ///< codec and filters
};

const std::vector<Kind>& kinds() {
    // The matrix and the tags of sRGB's primaries; without them players show different colours.
    static const std::vector<std::string> colors{"-vf",
                                                 "scale=out_color_matrix=bt709:out_range=tv",
                                                 "-pix_fmt",
                                                 "yuv420p",
                                                 "-colorspace",
                                                 "bt709",
                                                 "-color_primaries",
                                                 "bt709",
                                                 "-color_trc",
                                                 "iec61966-2-1",
                                                 "-color_range",
                                                 "tv"};
    static const auto withColors = [](std::vector<std::string> options) {
        options.insert(options.end(), colors.begin(), colors.end());
        return options;
    };
    static const std::vector<Kind> all{
        {".mp4", "mp4", true, withColors({"-c:v", "libx264", "-crf", "18", "-movflags", "+faststart"})},
        {".webm", "webm", true,
         withColors(
             {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-deadline", "good", "-cpu-used", "4"})},
        {".webp", "webp", false, {"-c:v", "libwebp_anim", "-lossless", "0", "-quality", "85", "-loop", "0"}},
        // Uses a palette per frame, so that frames need not be kept until the last one.
        {".gif",
         "gif",
         false,
         {"-filter_complex",
          "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=bayer:bayer_scale=5",
          "-loop", "0"}}};
    return all;
}

const Kind* kindOf(const fs::path& path) {
    const auto kind =
        std::ranges::find_if(kinds(), [&](const Kind& k) { return path.extension() == k.extension; });
    return kind == kinds().end() ? nullptr : &*kind;
}

bool isInstalled(const std::string& program) {
    const char* const folders = std::getenv("PATH");
    std::istringstream stream(folders ? folders : "/usr/bin:/bin");
    for (std::string folder; std::getline(stream, folder, ':');) {
        const fs::path file = fs::path(folder.empty() ? "." : folder) / program;
        if (!irregularity(file) && ::access(file.c_str(), X_OK) == 0) return true;
    }
    return false;
}

constexpr const char* notInstalled =
    "a clip is made by the program ffmpeg, which is not there: install the Debian package 'ffmpeg', or "
    "render "
    "frame.%04d.png";

std::vector<std::string> argumentsFor(const Kind& kind, const fs::path& file, uint32_t width, uint32_t height,
                                      double framesPerSecond) {
    std::vector<std::string> arguments{"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-y"};
    const auto add = [&](const std::vector<std::string>& more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
    };
    add({"-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", width, height)});
    add({"-framerate", fmt::format("{}", framesPerSecond), "-i", "pipe:0"});
    add(kind.options);
    // With the prefix "file:", a name cannot be taken for an option or a protocol.
    add({"-f", kind.container, "file:" + file.string()});
    return arguments;
}

// State for signal handlers, which delete the file of a render that ends at once. They can only use variables
// like these.
std::array<char, 4096> interruptedFile{};
volatile pid_t interruptedProcess = -1;

void removeFile() {
    if (interruptedProcess > 0) ::kill(interruptedProcess, SIGKILL);
    if (interruptedFile[0] != '\0') ::unlink(interruptedFile.data());
}

void removeOnInterrupt(const fs::path& file, pid_t process) {
    const std::string name = file.string();
    if (name.size() >= interruptedFile.size()) return;
    interruptedProcess = process;
    std::strncpy(interruptedFile.data(), name.c_str(), interruptedFile.size() - 1);
    beforeInterruptedEnd(removeFile);
}

void keepOnInterrupt() {
    if (interruptedFile[0] == '\0') return;
    beforeInterruptedEnd(nullptr);
    interruptedProcess = -1;
    interruptedFile[0] = '\0';
}

void closeFile(int& file) {
    if (file >= 0) ::close(file);
    file = -1;
}

/// Repeats the last column or row if their number is odd.
image::ByteImage madeEven(const image::ByteImage& frame) {
    image::ByteImage even{frame.width + frame.width % 2, frame.height + frame.height % 2, 3, {}};
    even.pixels.reserve(size_t{even.width} * even.height * 3);
    for (uint32_t y = 0; y < even.height; ++y) {
        const uint8_t* const row = &frame.pixels[size_t{std::min(y, frame.height - 1)} * frame.width * 3];
        const uint8_t* const end = row + size_t{frame.width} * 3;
        even.pixels.insert(even.pixels.end(), row, end);
        if (even.width != frame.width) even.pixels.insert(even.pixels.end(), end - 3, end);
    }
    return even;
}

}  // namespace

bool isClip(const fs::path& path) {
    return kindOf(path) != nullptr;
}

void checkClipOutput(const fs::path& path) {
    checkWritable(path);
    if (!isInstalled("ffmpeg")) throw Error(notInstalled);
}

ClipWriter::ClipWriter(const fs::path& file, const ClipFormat& format)
    : format_(format), evenSize_(kindOf(file)->evenSize) {
    start(file);
    removeOnInterrupt(file, process_);
}

void ClipWriter::start(const fs::path& file) {
    const uint32_t odd = evenSize_ ? 1 : 0;
    std::vector<std::string> arguments =
        argumentsFor(*kindOf(file), file, format_.width + (format_.width & odd),
                     format_.height + (format_.height & odd), format_.framesPerSecond);
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    pointers.push_back(nullptr);

    // A socket, because writing to a closed one can be done without raising a signal.
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw Error(std::string("ffmpeg cannot be started: ") + std::strerror(errno));
    input_ = ends[0];
    faults_ = ::memfd_create("ffmpeg", MFD_CLOEXEC);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, faults_, STDERR_FILENO);
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    // A process group of its own: Ctrl+C in the terminal goes to Limpid, which then stops ffmpeg.
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int fault = ::posix_spawnp(&process_, "ffmpeg", &actions, &attributes, pointers.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (fault == 0) return;
    process_ = -1;
    closeFile(input_);
    closeFile(faults_);
    throw Error(fault == ENOENT ? notInstalled
                                : std::string("ffmpeg cannot be started: ") + std::strerror(fault));
}

ClipWriter::~ClipWriter() {
    closeFile(input_);
    if (process_ > 0) {
        ::kill(process_, SIGKILL);
        wait();
    }
    closeFile(faults_);
    keepOnInterrupt();
}

int ClipWriter::wait() {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

std::string ClipWriter::lastWords() const {
    constexpr off_t maxBytes = 600;
    const off_t size = std::max<off_t>(::lseek(faults_, 0, SEEK_END), 0);
    std::string text(static_cast<size_t>(std::min(size, maxBytes)), '\0');
    const ssize_t got = ::pread(faults_, text.data(), text.size(), size - static_cast<off_t>(text.size()));
    text.resize(static_cast<size_t>(std::max<ssize_t>(got, 0)));
    // Keep whole lines only, without an empty one at the end.
    if (size > maxBytes) text.erase(0, text.find('\n') + 1);
    text.erase(text.find_last_not_of(" \r\n") + 1);
    return text;
}

void ClipWriter::fail(int status) const {
    const std::string words = lastWords();
    const std::string how = WIFSIGNALED(status)
                                ? fmt::format("was ended by signal {}", WTERMSIG(status))
                                : fmt::format("failed with exit code {}", WEXITSTATUS(status));
    throw Error(fmt::format("ffmpeg {}{}{}", how, words.empty() ? "" : ":\n", words));
}

void ClipWriter::send(const image::ByteImage& frame) {
    const uint8_t* from = frame.pixels.data();
    for (size_t left = frame.pixels.size(); left > 0;) {
        const ssize_t sent = ::send(input_, from, left, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0) {
            closeFile(input_);
            fail(wait());
        }
        from += sent;
        left -= static_cast<size_t>(sent);
    }
}

void ClipWriter::add(const image::Image& beauty, std::span<const float> subject) {
    // One exposure for all frames: a clip would flicker if each frame were measured.
    if (!format_.stops) format_.stops = image::autoExposure(beauty, subject);
    const image::Image encoded = format_.shownAsIs
                                     ? image::displayEncode(beauty, 0.0f)
                                     : image::tonemap(beauty, *format_.stops, format_.toneCurve);
    const image::ByteImage bytes = image::toBytes(encoded);
    if (bytes.width != format_.width || bytes.height != format_.height || bytes.components != 3)
        throw Error("the frames of a clip must be RGB, and all have its size");
    send(evenSize_ ? madeEven(bytes) : bytes);
    isEmpty_ = false;
}

void ClipWriter::finish() {
    closeFile(input_);
    const int status = wait();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail(status);
}

}  // namespace limpid::cli
