#include "cli/render/picture_output.h"

#include "base/error.h"
#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "renderer/frame/camera_text.h"
#include "renderer/frame/frame.h"
#include "renderer/long/merge/merge_frames.h"
#include "renderer/long/render_identity.h"

namespace limpid::cli {

namespace fs = std::filesystem;

void checkPictureOutput(const fs::path& path, bool layers) {
    limpid::checkPictureOutput(path);
    if (layers && !isExr(path)) throw UsageError("--aov needs an .exr output");
}

fs::path previewFile(fs::path output) {
    return isExr(output) ? output.replace_extension(".preview.png") : output;
}

PictureFormat formatOf(const AccumulationHeader& header) {
    return {header.layers, header.floatColors, header.exposure, image::parseToneCurve(header.toneCurve)};
}

std::map<std::string, std::string> metadataOf(const AccumulationHeader& header, uint64_t frame,
                                              uint64_t samples, const std::string& camera) {
    std::map<std::string, std::string> metadata{{"limpid.version", std::string(header.value(versionEntry))},
                                                {"limpid.scene", std::string(header.value(sceneEntry))},
                                                {"limpid.samples", std::to_string(samples)},
                                                {"limpid.seed", std::string(header.value(seedEntry))},
                                                {"limpid.device", header.device},
                                                {"limpid.driver", header.driver},
                                                {cameraAttribute, camera}};
    RenderSettings settings;
    settings.jitter = header.value(jitterEntry) == toString(Jitter::Frame) ? Jitter::Frame : Jitter::Off;
    if (const auto jitter = jitterOf(settings, frame, header.plan.samples))
        metadata[jitterAttribute] = jitterText(*jitter);
    metadata.merge(frameMetadata(header, frame));
    return metadata;
}

void writePicture(const fs::path& path, const PictureFormat& format, const RenderedLayers& layers,
                  const std::map<std::string, std::string>& metadata) {
    if (!isExr(path)) {
        const image::Image beauty = beautyOf(layers);
        if (format.shownAsIs)
            return image::writePng(path, image::toBytes(image::displayEncode(beauty, 0.0f)));
        const float stops =
            parseExposure(format.exposure).value_or(image::autoExposure(beauty, surfaceShare(layers)));
        image::writePng(path, image::toBytes(image::tonemap(beauty, stops, format.toneCurve)));
        return;
    }
    image::LayeredImage exr = toLayeredImage(
        layers, format.layers, format.floatColors ? image::Storage::Float : image::Storage::Half);
    exr.metadata = metadata;
    image::writeExr(path, exr);
}

}  // namespace limpid::cli
