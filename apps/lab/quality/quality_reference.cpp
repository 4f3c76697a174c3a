#include "lab/quality/quality_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/error.h"
#include "base/hash.h"
#include "cli/cluster/session.h"
#include "cli/console/progress.h"
#include "image/io/exr/exr.h"
#include "renderer/frame/frame_renderer.h"
#include "renderer/layers/layers.h"
#include "renderer/long/render_identity.h"

namespace limpid::cli {
namespace {

namespace fs = std::filesystem;
using image::Image;
using image::LayeredImage;

/// References always have independent random numbers. So frames of every sampler are compared with the same
/// ones, and share no points with them.
PathtraceSettings withoutSampler(PathtraceSettings settings) {
    settings.samplerTea = settings.samplerSobol = false;
    return settings;
}

/// Returns references as they are stored in a file, so that they do not depend on whether they were rendered
/// or read.
class ReferenceRenderer {
  public:
    ReferenceRenderer(gpu::Device& device, scene::GpuScene& scene, const RenderSettings& settings,
                      uint64_t samples)
        : first_(device, scene, settingsOf(settings, 1), samples / 2),
          second_(device, scene, settingsOf(settings, 2), samples - samples / 2),
          extent_(settings.extent) {}

    LayeredImage render(const Sequence& sequence, uint64_t frame) {
        const RenderedLayers first = layersOf(first_, sequence.moment(frame, extent_));
        Image difference = beautyOf(layersOf(second_, sequence.moment(frame, extent_)));
        Image picture = beautyOf(first);
        for (size_t i = 0; i < picture.pixels.size(); ++i) {
            const float other = difference.pixels[i];
            difference.pixels[i] -= picture.pixels[i];
            picture.pixels[i] = 0.5f * (picture.pixels[i] + other);
        }
        LayeredImage layers = toLayeredImage(first, {"motion", "depth", "normal"}, image::Storage::Float);
        std::erase_if(layers.channels, [](const image::Channel& c) { return c.name.size() == 1; });
        layers.add("", "RGB", picture, image::Storage::Float);
        layers.add("difference", "RGB", difference, image::Storage::Float);
        return layers;
    }

  private:
    /// `seed` must be different from that of the tested frames.
    static RenderSettings settingsOf(RenderSettings settings, uint32_t seed) {
        settings.seed = seed;
        settings.pathtrace = withoutSampler(settings.pathtrace);
        settings.pipeline.denoiser = nullptr;
        settings.samplesPerLaunch = 64;
        settings.layers = true;
        if (settings.jitter == Jitter::Frame) settings.jitter = Jitter::Pixel;
        return settings;
    }

    static RenderedLayers layersOf(FrameRenderer& renderer, Moment moment) {
        renderer.begin(std::move(moment));
        while (renderer.launch()) {
            if (ranks()) ranks()->beat();
        }
        return renderer.download();
    }

    FrameRenderer first_, second_;
    gpu::Extent extent_;
};

Reference referenceOf(const LayeredImage& layers) {
    return {layers.get("", "RGB"), image::geometryOf(layers), layers.get("difference", "RGB")};
}

/// Hashes everything that determines the frame's pixels, except its size and the noise.
uint64_t identityOf(const ReferenceFiles& files, const Sequence& sequence, const RenderSettings& settings,
                    uint64_t frame) {
    const Moment moment = sequence.moment(frame, settings.extent);
    Hash64 hash;
    hash.addValue(files.sceneHash);
    hash.addValue(frame);
    hash.addValue(moment.camera);
    hash.addValue(moment.previousCamera.value_or(moment.camera));
    hash.addValue(uint32_t{moment.previousCamera.has_value()});
    const auto addParameters = [&](const auto& table, const auto& values) {
        for (size_t i = 0; i < table.infos().size(); ++i) hash.add(toString(table.get(values, i)) + "\n");
    };
    addParameters(pathtraceParams(), withoutSampler(settings.pathsTraced()));
    if (settings.pipeline.integrator == Integrator::AmbientOcclusion) {
        hash.add("ambient occlusion\n");
        addParameters(ambientOcclusionParams(), settings.ambientOcclusion);
    }
    if (settings.jitter != Jitter::Off) hash.add("means over the pixels\n");
    return hash.value();
}

std::string fileName(std::string sequence, gpu::Extent extent, uint64_t samples, const std::string& identity,
                     uint64_t frame) {
    for (char& c : sequence) {
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    }
    return fmt::format("{}.{}x{}.{}spp.{}.{:04}.exr", sequence, extent.width, extent.height, samples,
                       identity, frame);
}

/// Throws InputError unless the file is the reference that its name says.
void checkFile(const fs::path& file, const LayeredImage& layers, gpu::Extent extent,
               const std::map<std::string, std::string>& metadata) {
    if (layers.width != extent.width || layers.height != extent.height) {
        throw InputError(file, fmt::format("is {}x{} pixels, not {}x{}", layers.width, layers.height,
                                           extent.width, extent.height));
    }
    for (const auto& [name, value] : metadata) {
        const auto found = layers.metadata.find(name);
        if (found == layers.metadata.end() || found->second != value)
            throw InputError(file, "is no reference of this frame: its " + name + " is not " + value);
    }
    for (const char* name : {"R", "G", "B", "difference.R", "difference.G", "difference.B", "motion.X",
                             "motion.Y", "motion.Z", "depth.Z", "normal.X", "normal.Y", "normal.Z"}) {
        const image::Channel* channel = layers.find(name);
        if (!channel) throw InputError(file, fmt::format("is no reference: it has no channel {}", name));
        if (!std::ranges::all_of(channel->values, [](float v) { return std::isfinite(v); }))
            throw InputError(file, fmt::format("has values in {} that are NaN or infinite", name));
    }
}

}  // namespace

std::vector<Reference> makeReferences(gpu::Device& device, scene::GpuScene& scene, const Sequence& sequence,
                                      const RenderSettings& settings, const QualityFrames& frames,
                                      uint64_t samples, const ReferenceFiles& files) {
    ReferenceRenderer renderer(device, scene, settings, samples);
    Progress progress("references", frames.count - frames.first);
    std::vector<Reference> references;
    for (uint64_t frame = frames.first; frame < frames.count; ++frame) {
        progress.show(references.size());
        if (files.folder.empty()) {
            references.push_back(referenceOf(renderer.render(sequence, frame)));
            continue;
        }
        const std::string identity = hashText(identityOf(files, sequence, settings, frame));
        const fs::path file =
            files.folder / fileName(files.sequence, settings.extent, samples, identity, frame);
        const std::map<std::string, std::string> metadata{{"limpid.reference", identity},
                                                          {"limpid.frame", std::to_string(frame)},
                                                          {"limpid.samples", std::to_string(samples)}};
        LayeredImage layers;
        if (fs::exists(file)) {
            layers = image::readExr(file);
            checkFile(file, layers, settings.extent, metadata);
        } else {
            layers = renderer.render(sequence, frame);
            layers.metadata = metadata;
            image::writeExr(file, layers);
        }
        references.push_back(referenceOf(layers));
    }
    return references;
}

}  // namespace limpid::cli
