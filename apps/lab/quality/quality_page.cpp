#include "lab/quality/quality_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files/file.h"
#include "image/colormap.h"
#include "image/io/png/png.h"
#include "image/metrics/metrics.h"
#include "lab/quality/quality_json.h"
#include "quality_page.html.h"

namespace limpid::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Returns encoded values in [0,1] as a data URI.
std::string pngUri(const image::Image& encoded) {
    return "data:image/png;base64," +
           base64(image::encodePng(image::toBytes(encoded), "a picture of the report"));
}

/// Returns the colours of error maps, from 0 to 1.
Json colorScale() {
    Json colors = Json::array();
    for (int i = 0; i <= 16; ++i) {
        const image::Image color = image::magma(image::Image(1, 1, 1, static_cast<float>(i) / 16.0f));
        const image::ByteImage bytes = image::toBytes(color);
        colors.push_back(
            fmt::format("#{:02x}{:02x}{:02x}", bytes.pixels[0], bytes.pixels[1], bytes.pixels[2]));
    }
    return colors;
}

/// Adds pictures as the metrics see them: exposed, clamped, sRGB.
void addPictures(Json& object, const SequenceQuality& quality) {
    object["reference_picture"] = pngUri(image::displayEncode(quality.reference, quality.exposure));
    for (size_t i = 0; i < quality.methods.size(); ++i) {
        const MethodQuality& method = quality.methods[i];
        object["methods"][i]["picture"] = pngUri(image::displayEncode(method.last, quality.exposure));
        object["methods"][i]["error_map"] = pngUri(image::magma(method.lastError));
    }
}

}  // namespace

std::string base64(std::span<const char> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) text += k <= count ? digits[bits >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

std::string jsonForScript(const Json& json) {
    const std::string plain = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    std::string text;
    text.reserve(plain.size());
    // In JSON these characters only occur in strings, where they may be escaped.
    for (const char c : plain) {
        if (c == '<' || c == '>' || c == '&') {
            text += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
        } else {
            text += c;
        }
    }
    return text;
}

std::string qualityPage(const QualityRun& run) {
    Json json = qualityJson(run);
    json["color_scale"] = colorScale();
    for (size_t i = 0; i < run.sequences.size(); ++i)
        addPictures(json["scenes"][i], run.sequences[i].quality);
    constexpr std::string_view placeholder = "@QUALITY_JSON@";
    std::string page(embedded::quality_page_html);
    const size_t at = page.find(placeholder);
    if (at == std::string::npos) throw Error("the page has no place for its data");
    return page.replace(at, placeholder.size(), jsonForScript(json));
}

void writeQualityPage(const std::filesystem::path& file, const QualityRun& run) {
    writeTextAtomically(file, qualityPage(run));
}

}  // namespace limpid::cli
