#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/error.h"
#include "base/file.h"
#include "base/log.h"
#include "commands.h"
#include "image/colormap.h"
#include "image/metrics.h"
#include "image/picture.h"
#include "image/tonemap.h"

namespace limpid::cli {
namespace {

struct Options {
    std::filesystem::path test;
    std::filesystem::path reference;
    std::filesystem::path errorMap;
    std::string exposure;  ///< "", "auto" or stops
    bool json = false;
};

/// The stops that --exposure names; none for "auto".
std::optional<float> parseExposure(const std::string& text) {
    if (text == "auto") return std::nullopt;
    const std::string_view number = std::string_view(text).substr(text.starts_with('+') ? 1 : 0);
    float stops = 0.0f;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), stops);
    // 2^stops, and radiance times it, must stay within a float.
    if (error != std::errc{} || end != number.data() + number.size() || !(std::abs(stops) <= 60.0f)) {
        throw UsageError(
            fmt::format("--exposure: '{}' is neither 'auto' nor a number of stops from -60 to 60", text));
    }
    return stops;
}

float chooseExposure(const Options& options, const image::Picture& reference) {
    if (options.exposure.empty())
        return reference.sceneReferred ? image::autoExposure(reference.linear) : 0.0f;
    const std::optional<float> stops = parseExposure(options.exposure);
    return stops ? *stops : image::autoExposure(reference.linear);
}

void checkSizes(const Options& options, const image::Image& test, const image::Image& reference) {
    if (test.width == reference.width && test.height == reference.height) return;
    throw InputError(options.test,
                     fmt::format("is {}x{} pixels, but {} is {}x{}", test.width, test.height,
                                 options.reference.string(), reference.width, reference.height));
}

void checkReference(const Options& options, const image::Image& reference) {
    size_t invalid = 0;
    for (const float value : reference.pixels) invalid += std::isfinite(value) ? 0 : 1;
    if (invalid == 0) return;
    throw InputError(options.reference,
                     fmt::format("has {} values that are NaN or infinite: no reference", invalid));
}

std::string toJson(const image::Comparison& c) {
    nlohmann::ordered_json json;
    // JSON has no infinity: equal images have the PSNR null.
    json["psnr"] = std::isfinite(c.psnr) ? nlohmann::ordered_json(c.psnr) : nlohmann::ordered_json(nullptr);
    json["ssim"] = c.ssim;
    json["relmse"] = c.relMse;
    json["flip"] = c.flip;
    json["exposure"] = c.exposure;
    json["width"] = c.flipMap.width;
    json["height"] = c.flipMap.height;
    json["invalid_pixels"] = c.invalidPixels;
    return json.dump();
}

std::string toTable(const image::Comparison& c) {
    std::string text;
    text += fmt::format("psnr      {:>12.4f} dB\n", c.psnr);
    text += fmt::format("ssim      {:>12.6f}\n", c.ssim);
    text += fmt::format("relmse    {:>12.6g}\n", c.relMse);
    text += fmt::format("flip      {:>12.6f}\n", c.flip);
    text += fmt::format("exposure  {:>+12.4f} stops\n", c.exposure);
    text += fmt::format("size      {:>12}\n", fmt::format("{}x{}", c.flipMap.width, c.flipMap.height));
    text += fmt::format("invalid   {:>12} pixels\n", c.invalidPixels);
    return text;
}

void runCompare(const Options& options) {
    // What is wrong with the command line, or with where the map goes, shows before any work.
    if (!options.exposure.empty()) parseExposure(options.exposure);
    if (!options.errorMap.empty()) {
        if (options.errorMap.extension() != ".png")
            throw UsageError("--error-map: the file's name must end in .png");
        checkWritable(options.errorMap);
    }
    const image::Picture test = image::readPicture(options.test);
    const image::Picture reference = image::readPicture(options.reference);
    checkSizes(options, test.linear, reference.linear);
    checkReference(options, reference.linear);

    const float stops = chooseExposure(options, reference);
    const image::Comparison result = image::compare(test.linear, reference.linear, stops);
    if (!options.errorMap.empty()) image::writeErrorMap(options.errorMap, result.flipMap);
    if (result.invalidPixels > 0) {
        log::warn("{}: {} pixels are NaN or infinite; they count as the worst error", options.test.string(),
                  result.invalidPixels);
    }
    fmt::print("{}", options.json ? toJson(result) + "\n" : toTable(result));
}

}  // namespace

void addCompareCommand(CLI::App& app) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("compare", "Measure how far a picture is from its reference");
    command->add_option("TEST", options->test, "The picture to judge: EXR, HDR, PNG or JPEG")->required();
    command
        ->add_option("REFERENCE", options->reference,
                     "The picture it should be; any of these formats, of the same size")
        ->required();
    command->add_flag("--json", options->json,
                      "Print one JSON object: psnr (dB; null for equal pictures, where it is infinite), "
                      "ssim, relmse, flip, "
                      "exposure (stops), width, height, invalid_pixels");
    command->add_option("--error-map", options->errorMap,
                        "Write the FLIP error of each pixel as a PNG (magma: black 0, yellow 1)");
    command
        ->add_option(
            "--exposure", options->exposure,
            "Stops for psnr, ssim and flip, which see the exposed picture clamped to [0,1] and sRGB-encoded; "
            "'auto' brings the reference's average luminance to 0.18. Default: auto for an EXR or HDR "
            "reference, "
            "0 for PNG or JPEG. relmse is of unexposed linear values")
        ->type_name("STOPS|auto");
    command->footer(
        "psnr and ssim: higher is better; ssim is of luma, 11x11 Gaussian window within the picture. "
        "flip: LDR-FLIP at 67 pixels per degree, 0 to 1, lower is better. relmse: mean of "
        "(x-r)^2/(r^2+0.01). "
        "A NaN or infinite pixel in TEST counts as the worst error; in REFERENCE it is refused.");
    command->callback([options] { runCompare(*options); });
}

}  // namespace limpid::cli
