// `limpid bench files`: how fast frames are read and written without denoising. It is the yardstick of
// `limpid denoise`.
#include <fmt/format.h>

#include <chrono>
#include <future>
#include <memory>

#include "base/error.h"
#include "base/files/frame_pattern.h"
#include "cli/console/json_text.h"
#include "image/io/exr/exr_document.h"
#include "lab/bench.h"

namespace limpid::cli {
namespace {

struct FilesOptions {
    std::string input, output;
    bool json = false;
};

/// Reads a frame and decodes all its channels.
image::ExrDocument decoded(const std::filesystem::path& path) {
    image::ExrDocument file = image::ExrDocument::read(path);
    for (size_t part = 0; part < file.parts().size(); ++part)
        if (file.parts()[part].unreadable.empty()) file.decode(part);
    return file;
}

/// Replaces a channel by itself, so that the file is encoded anew.
void encode(image::ExrDocument file, const std::filesystem::path& path) {
    const std::string channel = file.parts().front().channels.front().name;
    file.replace(0, channel, file.values(0, channel));
    file.write(path);
}

void benchFiles(const FilesOptions& o) {
    using Clock = std::chrono::steady_clock;
    const FramePattern input(o.input), output(o.output);
    if (!input.numbered() || !output.numbered())
        throw UsageError("both names hold a frame number: frame.%04d.exr");
    const std::vector<int> frames = input.wholeSequence();
    const auto start = Clock::now();
    const auto read = [&](size_t i) {
        return std::async(std::launch::async, [&, i] { return decoded(input.format(frames[i])); });
    };
    std::future<image::ExrDocument> reading = read(0);
    std::future<void> writing;
    for (size_t i = 0; i < frames.size(); ++i) {
        image::ExrDocument file = reading.get();
        if (i + 1 < frames.size()) reading = read(i + 1);
        if (writing.valid()) writing.get();
        writing = std::async(std::launch::async, [&, i, moved = std::move(file)]() mutable {
            encode(std::move(moved), output.format(frames[i]));
        });
    }
    writing.get();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    const double rate = static_cast<double>(frames.size()) / seconds;
    if (o.json)
        fmt::print("{}\n",
                   jsonText({{"frames", frames.size()}, {"seconds", seconds}, {"frames_per_second", rate}}));
    else
        fmt::print("{} frames in {:.2f} s: {:.2f} frames/s\n", frames.size(), seconds, rate);
}

}  // namespace

void addFilesBench(CLI::App& bench) {
    CLI::App* command = bench.add_subcommand(
        "files", "Read and write EXR frames without denoising them: what 'limpid denoise' can reach at most");
    auto o = std::make_shared<FilesOptions>();
    command->add_option("IN", o->input, "Input: frame.%04d.exr")->required();
    command->add_option("-o,--output", o->output, "Output: frame.%04d.exr")->required();
    command->add_flag("--json", o->json, "Print one JSON object on stdout");
    command->callback([o] { benchFiles(*o); });
}

}  // namespace limpid::cli
