#include "lab/quality/report/quality_page.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files/file.h"
#include "image/colormap.h"
#include "image/io/png/png.h"
#include "lab/quality/report/quality_json.h"
#include "quality_page.html.h"
#include "quality_viewer.js.h"

namespace limpid::cli {
namespace {

using Json = nlohmann::ordered_json;

/// The data URIs of PNGs; null for those that were dropped.
Json pngUris(const std::vector<std::vector<char>>& pictures) {
    Json uris = Json::array();
    for (const std::vector<char>& png : pictures)
        uris.push_back(png.empty() ? Json() : Json("data:image/png;base64," + base64(png)));
    return uris;
}

/// Returns the colours of error maps, from 0 to 1 in steps of 1/255.
Json colorScale() {
    Json colors = Json::array();
    for (int i = 0; i <= 255; ++i) {
        const image::Image color = image::magma(image::Image(1, 1, 1, static_cast<float>(i) / 255.0f));
        const image::ByteImage bytes = image::toBytes(color);
        colors.push_back(
            fmt::format("#{:02x}{:02x}{:02x}", bytes.pixels[0], bytes.pixels[1], bytes.pixels[2]));
    }
    return colors;
}

void addPictures(Json& object, const SequenceQuality& quality) {
    object["reference_pictures"] = pngUris(quality.referencePictures);
    for (size_t i = 0; i < quality.methods.size(); ++i) {
        const MethodQuality& method = quality.methods[i];
        object["methods"][i]["pictures"] = pngUris(method.pictures);
        object["methods"][i]["error_maps"] = pngUris(method.errorMaps);
    }
}

/// Every list of pictures of a sequence; each has one of every compared frame.
std::vector<std::vector<std::vector<char>>*> pictureLists(SequenceQuality& quality) {
    std::vector<std::vector<std::vector<char>>*> lists{&quality.referencePictures};
    for (MethodQuality& method : quality.methods) {
        lists.push_back(&method.pictures);
        lists.push_back(&method.errorMaps);
    }
    return lists;
}

/// Puts `text` in the place of the only `placeholder`.
std::string filled(std::string page, std::string_view placeholder, std::string_view text) {
    const size_t at = page.find(placeholder);
    if (at == std::string::npos) throw Error(fmt::format("the page has no {}", placeholder));
    return page.replace(at, placeholder.size(), text);
}

}  // namespace

void keepWithin(SequenceQuality& quality, uint64_t bytes) {
    const size_t frames = quality.referencePictures.size();
    std::vector<uint64_t> sizes(frames);
    for (const auto* list : pictureLists(quality)) {
        for (size_t i = 0; i < frames; ++i) sizes[i] += (*list)[i].size();
    }
    const auto keeps = [&](size_t step, size_t frame) { return (frames - 1 - frame) % step == 0; };
    const auto total = [&](size_t step) {
        uint64_t sum = 0;
        for (size_t i = 0; i < frames; ++i) sum += keeps(step, i) ? sizes[i] : 0;
        return sum;
    };
    size_t step = 1;
    while (step < frames && total(step) > bytes) ++step;
    for (auto* list : pictureLists(quality)) {
        for (size_t i = 0; i < frames; ++i) {
            if (!keeps(step, i)) std::vector<char>().swap((*list)[i]);
        }
    }
}

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
    // The data come last: they may contain any text.
    std::string page =
        filled(std::string(embedded::quality_page_html), "@QUALITY_VIEWER@", embedded::quality_viewer_js);
    return filled(std::move(page), "@QUALITY_JSON@", jsonForScript(json));
}

void writeQualityPage(const std::filesystem::path& file, const QualityRun& run) {
    writeTextAtomically(file, qualityPage(run));
}

}  // namespace limpid::cli
