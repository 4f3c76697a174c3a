#include "renderer/layers/picture_name.h"

#include "base/error.h"
#include "base/files/file.h"
#include "base/params.h"

namespace limpid {

std::optional<float> parseExposure(const std::string& text) {
    if (text == "auto") return std::nullopt;
    const ParamValue value = parseParam("--exposure", text, ParamValue(0.0f));
    checkRange("--exposure", {"stops", 0.0f, -100.0, 100.0, "stops", ""}, value);
    return std::get<float>(value);
}

bool isExr(const std::filesystem::path& path) {
    return path.extension() == ".exr";
}

void checkPictureOutput(const std::filesystem::path& path) {
    if (!isExr(path) && path.extension() != ".png")
        throw UsageError("'" + path.string() + "': an output's name ends in .exr or .png");
    checkWritable(path);
}

}  // namespace limpid
