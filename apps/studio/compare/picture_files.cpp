#include "studio/compare/picture_files.h"

#include <fmt/format.h>

#include "image/io/exr/exr.h"
#include "image/io/png/png.h"
#include "image/tonemap.h"

namespace limpid::studio {

namespace fs = std::filesystem;

fs::path unusedFile(const std::string& stem, const std::string& extension) {
    fs::path file = stem + extension;
    for (int number = 2; fs::exists(file); ++number) file = fmt::format("{}-{}{}", stem, number, extension);
    return file;
}

void savePicture(const fs::path& file, LiveRender& picture, float stops, image::ToneCurve curve) {
    const RenderedLayers layers = picture.renderer().download();
    if (file.extension() != ".exr") {
        image::writePng(file, image::toBytes(image::tonemap(beautyOf(layers), stops, curve)));
        return;
    }
    const RenderSettings& settings = picture.settings();
    const auto names = settings.layers ? settings.pipeline.layers() : std::vector<std::string>();
    image::writeExr(file, toLayeredImage(layers, names, image::Storage::Float));
}

}  // namespace limpid::studio
