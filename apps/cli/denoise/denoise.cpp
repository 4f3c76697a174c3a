// `limpid denoise`: denoises EXR frames from any renderer.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files/frame_pattern.h"
#include "base/log.h"
#include "cli/options/device_options.h"
#include "cli/options/former_options.h"
#include "cli/options/pipeline_options.h"
#include "cli/render/picture_output.h"
#include "cli/render/render_job.h"
#include "commands.h"
#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/tonemap.h"
#include "json_text.h"
#include "progress.h"
#include "renderer/frame/frame_download.h"
#include "renderer/frame/network_file.h"
#include "renderer/frame/parameters.h"
#include "renderer/frame/presets.h"
#include "renderer/layers/frame_file.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;
using image::LayeredImage;

struct DenoiseOptions {
    std::string input, output, denoiser, exposure = "auto", dump, weights;
    std::string preset;
    std::vector<std::string> assignments;
    DeviceChoice device;
    bool json = false;
};

/// Returns the denoiser of --denoiser, else of --preset.
const denoise::Denoiser& chosenDenoiser(const DenoiseOptions& o) {
    const Pipeline pipeline = pipelineFor(o.preset, {.integrator = {}, .denoiser = o.denoiser}, {});
    if (pipeline.denoiser) return *pipeline.denoiser;
    throw UsageError("--denoiser is missing; it is one of " + listOfDenoisers());
}

denoise::DenoiserSettings settingsOf(const DenoiseOptions& o) {
    RenderSettings settings;
    applyPreset(settings, o.preset);
    for (const std::string& text : o.assignments) assign(settings, text);
    return settings.denoisers;
}

/// Returns all frames of the sequence, or -1 for a single file.
std::vector<int> framesOf(const FramePattern& input, const FramePattern& output) {
    if (input.numbered() != output.numbered())
        throw UsageError("'" + output.text() + "': the output's name holds a number if the input's does");
    return input.numbered() ? input.wholeSequence() : std::vector<int>{-1};
}

/// Replaces the file's beauty. All other layers stay, for metrics and further filters.
LayeredImage withBeauty(LayeredImage file, const std::vector<float>& beauty, std::string_view method) {
    const image::Channel* before = file.find("R");
    const image::Storage storage = before ? before->storage : image::Storage::Half;
    std::erase_if(file.channels, [](const image::Channel& channel) {
        return channel.name == "R" || channel.name == "G" || channel.name == "B" || channel.name == "A";
    });
    image::Image picture(file.width, file.height, 4);
    picture.pixels = beauty;
    file.add("", "RGBA", picture, storage);
    file.metadata["limpid.denoiser"] = method;
    return file;
}

/// Returns 1 for pixels that see a surface, else 0.
std::vector<float> surfaces(const LayeredImage& file) {
    const image::Channel* depth = file.find("depth.Z");
    if (!depth) return {};
    std::vector<float> result = depth->values;
    for (float& distance : result) distance = distance > 0.0f && distance < missDepth ? 1.0f : 0.0f;
    return result;
}

void write(const DenoiseOptions& o, const fs::path& path, LayeredImage file,
           const std::vector<float>& beauty) {
    const LayeredImage result = withBeauty(std::move(file), beauty, chosenDenoiser(o).name);
    if (isExr(path)) return image::writeExr(path, result);
    const image::Image picture = result.get("", "RGB");
    const float stops = parseExposure(o.exposure).value_or(image::autoExposure(picture, surfaces(result)));
    image::writePng(path, image::toBytes(image::tonemap(picture, stops)));
}

void warnOfLacking(const std::vector<const LayerInfo*>& lacking) {
    for (const LayerInfo* layer : lacking)
        log::warn("the layer '{}' is missing: {}", layer->name, layer->without);
}

struct DenoiseSummary {
    int frames = 0;
    denoise::DisocclusionCounts disocclusion;
    std::map<std::string, double> lastFrame;
};

DenoiseSummary denoiseFrames(const DenoiseOptions& o, gpu::Device& device) {
    const denoise::Denoiser& method = chosenDenoiser(o);
    const denoise::DenoiserSettings settings = settingsOf(o);
    const denoise::DenoiserNetworks networks = loadNetworks(device, &method, o.weights, settings);
    const FramePattern input(o.input), output(o.output);
    const std::vector<int> frames = framesOf(input, output);
    Progress progress("frames", frames.size());
    gpu::FrameGraph graph;
    DenoiseSummary summary;
    for (const int frame : frames) {
        const fs::path name = input.format(std::max(frame, 0)), result = output.format(std::max(frame, 0));
        LayeredImage file = image::readExr(name);
        std::vector<const LayerInfo*> lacking;
        if (method.network) requireVariances(file, name);
        const denoise::HostFrame host = frameOf(file, name, frames.size() > 1 && !method.network, lacking);
        if (summary.frames == 0) warnOfLacking(lacking);
        graph.beginFrame();
        denoise::DenoiserInput images = denoise::upload(graph, host);
        images.filters = gpu::filterBacking(device);
        const denoise::DenoiserOutput denoised = method.record(graph, images, settings, networks);
        graph.execute(device);
        write(o, result, std::move(file), graph.downloadFloat(device, denoised.beauty));
        if (!o.dump.empty()) writeDump(result, imagesOfPass(graph, device, o.dump));
        if (denoised.disocclusion)
            summary.disocclusion =
                denoise::countDisocclusion(graph.downloadUint(device, denoised.disocclusion));
        if (summary.disocclusion.rejected > 0)
            log::warn("{}: {} pixels are NaN or infinite and were left out", name.string(),
                      summary.disocclusion.rejected);
        summary.lastFrame = sumByName(graph.passTimes(device));
        progress.show(static_cast<uint64_t>(++summary.frames));
    }
    return summary;
}

void denoiseFiles(const DenoiseOptions& o) {
    parseExposure(o.exposure);
    checkPictureOutput(FramePattern(o.output).format(0), false);
    chosenDenoiser(o);
    settingsOf(o);
    const OpenDevice device = openDevice(o.device);
    const DenoiseSummary summary = denoiseFrames(o, *device);
    if (o.json) {
        const nlohmann::json object{{"output", o.output},
                                    {"denoiser", chosenDenoiser(o).name},
                                    {"device", device->info().name},
                                    {"frames", summary.frames},
                                    {"last_frame_ms", summary.lastFrame}};
        fmt::print("{}\n", jsonText(object));
    } else {
        log::info("{} frames by {}, on {}", summary.frames, chosenDenoiser(o).name, device->info().name);
    }
    if (device->validationMessages() > 0)
        throw Error(fmt::format("the validation layer reported {} messages", device->validationMessages()));
}

}  // namespace

void addDenoiseCommand(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("denoise", "Denoise EXR frames that have the layers of docs/layers.md");
    auto o = std::make_shared<DenoiseOptions>();
    command->add_option("IN", o->input, "Input: frame.exr, or frame.%04d.exr for all existing frames")
        ->required();
    command
        ->add_option("-o,--output", o->output,
                     "Output: EXR (all layers of the input, with a new beauty) or PNG")
        ->required();
    command->add_option("--denoiser", o->denoiser,
                        "Denoiser: " + listOfDenoisers() + "; required unless --preset names one");
    refuseMethodOption(*command);
    command->add_option("--preset", o->preset,
                        "Use a denoiser with the settings of a paper or course; 'limpid info' lists them; "
                        "other options override it");
    command->add_option("--set", o->assignments,
                        "Set a parameter: group.name=value; 'limpid info' lists them (repeatable)");
    command->add_option("--weights", o->weights,
                        "Weights file for kpcn instead of the one that comes with Limpid");
    command->add_option("--exposure", o->exposure,
                        "Exposure of a PNG: stops (higher is brighter), or 'auto' (default): measured on "
                        "pixels that see a surface");
    command->add_option("--dump", o->dump, "Also write the images of this pass, beside the output");
    command->add_flag("--json", o->json, "Print one JSON object about the run on stdout");
    addDeviceOptions(*command, o->device);
    command->callback([o] { denoiseFiles(*o); });
}

}  // namespace limpid::cli
