// `limpid merge`: merges the shards of a render into the result of a single run.
#include "renderer/long/merge/merge.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files/frame_pattern.h"
#include "base/log.h"
#include "base/text/format.h"
#include "cli/console/json_text.h"
#include "cli/render/picture_output.h"
#include "commands.h"
#include "renderer/long/merge/merge_frames.h"
#include "renderer/long/render_identity.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
    std::vector<std::string> inputs;
    std::string output;
    bool json = false;
};

nlohmann::json mergeStill(const MergeOptions& o, const FramePattern& output) {
    const fs::path path = output.format(0);
    checkPictureOutput(path, false);
    const std::vector<fs::path> files(o.inputs.begin(), o.inputs.end());
    const Accumulation sum = mergeAccumulations(files);
    checkPictureOutput(path, !sum.header.layers.empty());
    writePicture(path, formatOf(sum.header), sum.sums.means(),
                 metadataOf(sum.header, 0, sum.sums.samples(), std::string(sum.header.value(cameraEntry))));
    log::info("{} of {}x{} from {} files", countText(sum.sums.samples(), "sample"), sum.header.extent.width,
              sum.header.extent.height, files.size());
    return {{"output", o.output}, {"samples", sum.sums.samples()}, {"files", files.size()}};
}

nlohmann::json mergeSequence(const MergeOptions& o, const FramePattern& output) {
    if (!isExr(output.format(0))) {
        throw UsageError(
            "'" + o.output +
            "': frames are merged as they are, .exr; PNG frames need only be put into one folder");
    }
    checkPictureOutput(output.format(0), false);
    std::vector<FramePattern> inputs;
    for (const std::string& text : o.inputs) {
        inputs.emplace_back(text);
        if (!inputs.back().numbered())
            throw UsageError("'" + text +
                             "': the name of several frames holds a number, as in frame.%04d.exr");
    }
    const int frames = mergeFrames(inputs, output);
    log::info("{} frames from {} shards", frames, inputs.size());
    return {{"output", o.output}, {"frames", frames}, {"shards", inputs.size()}};
}

void merge(const MergeOptions& o) {
    const FramePattern output(o.output);
    const nlohmann::json report = output.numbered() ? mergeSequence(o, output) : mergeStill(o, output);
    if (o.json) fmt::print("{}\n", jsonText(report));
}

}  // namespace

void addMergeCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("merge", "Merge the shards of a render (limpid render --shard)");
    auto options = std::make_shared<MergeOptions>();
    command
        ->add_option(
            "FILE", options->inputs,
            "The .sums files of a still, in any order, or the frames of a sequence, as in a.%04d.exr")
        ->required();
    command
        ->add_option("-o,--output", options->output,
                     "Output: .exr or .png, as a single run would write it; frame.%04d.exr for a sequence")
        ->required();
    command->add_flag("--json", options->json, "Print one JSON object about the result on stdout");
    command->callback([options] { merge(*options); });
}

}  // namespace limpid::cli
