#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/files/file.h"
#include "base/log.h"
#include "cli/commands.h"
#include "cli/compare/compare_report.h"
#include "cli/console/progress.h"
#include "cli/options/compare_options.h"
#include "image/colormap.h"
#include "image/io/picture.h"
#include "image/metrics/metrics.h"
#include "image/tonemap.h"
#include "renderer/layers/picture_name.h"

namespace limpid::cli {
namespace {

/// The arguments as given on the command line; empty if not given.
struct Arguments {
    std::string test, reference, errorMap, hdrErrorMap, exposure;
    bool json = false;
};

/// Parses the output name of a map. Reports faults before any work is done.
std::optional<FramePattern> parseMap(const char* option, const std::string& text, bool sequence) {
    if (text.empty()) return std::nullopt;
    FramePattern pattern(text);
    if (pattern.numbered() != sequence) {
        throw UsageError(fmt::format("{}: '{}' {}", option, text,
                                     sequence ? "needs a frame number (%04d), for TEST is a sequence"
                                              : "has a frame number, but TEST is one picture"));
    }
    const std::filesystem::path first = pattern.format(0);
    if (first.extension() != ".png")
        throw UsageError(fmt::format("{}: the file's name must end in .png", option));
    checkWritable(first);
    return pattern;
}

/// Whether a frame of the map has the same file as one of the others.
bool meets(const FramePattern& map, const FramePattern& other) {
    constexpr int longest = 1'000'000'000;  // no pattern pads so long a number
    if (isSameFile(map.format(longest), other.format(longest))) return true;
    if (!map.numbered() || other.numbered()) return false;
    const std::optional<int> frame = map.frameOf(other.format(0).filename().string());
    return frame && isSameFile(map.format(*frame), other.format(0));
}

/// A map would replace what it shows, or the other map.
void checkMapsAreNoInputs(const CompareOptions& o) {
    const auto refuse = [](const FramePattern& map, const FramePattern& other, const char* what) {
        if (meets(map, other))
            throw UsageError(
                fmt::format("'{}' is {}: an error map needs files of its own", map.text(), what));
    };
    for (const std::optional<FramePattern>& map : {o.errorMap, o.hdrErrorMap}) {
        if (!map) continue;
        refuse(*map, o.test, "TEST");
        refuse(*map, o.reference, "REFERENCE");
    }
    if (o.errorMap && o.hdrErrorMap) refuse(*o.errorMap, *o.hdrErrorMap, "the other map, too");
}

CompareOptions parse(const Arguments& arguments) {
    CompareOptions options{.test = FramePattern(arguments.test),
                           .reference = FramePattern(arguments.reference)};
    const bool sequence = options.test.numbered();
    if (options.reference.numbered() && !sequence) {
        throw UsageError(fmt::format("'{}' is a sequence, '{}' one picture: what is it to be compared with?",
                                     arguments.reference, arguments.test));
    }
    if (!arguments.exposure.empty()) options.stops = parseExposure(arguments.exposure);
    options.autoExposure = arguments.exposure == "auto";
    options.errorMap = parseMap("--error-map", arguments.errorMap, sequence);
    options.hdrErrorMap = parseMap("--hdr-error-map", arguments.hdrErrorMap, sequence);
    checkMapsAreNoInputs(options);
    options.json = arguments.json;
    return options;
}

float chooseStops(const CompareOptions& options, const image::Picture& reference) {
    if (options.stops) return *options.stops;
    return options.autoExposure || reference.sceneReferred ? image::autoExposure(reference.linear) : 0.0f;
}

/// Shows progress on a terminal, since large pictures take seconds.
image::HdrFlip hdrFlipWithProgress(const image::Image& test, const image::Image& reference) {
    std::optional<Progress> progress;
    return image::hdrFlip(test, reference, image::flipPixelsPerDegree, [&](int done, int count) {
        if (!progress) progress.emplace("exposures of HDR-FLIP", static_cast<uint64_t>(count));
        progress->show(static_cast<uint64_t>(done));
    });
}

void comparePictures(const CompareOptions& options) {
    const std::filesystem::path testFile = options.test.format(0),
                                referenceFile = options.reference.format(0);
    const image::Picture test = image::readPicture(testFile);
    const image::Picture reference = image::readPicture(referenceFile);
    checkSameSize(testFile, test.linear, referenceFile, reference.linear);
    checkReferenceFinite(referenceFile, reference.linear);
    const bool bothHdr = haveHdrFlip(options, testFile, test, referenceFile, reference);

    const image::Comparison result =
        image::compare(test.linear, reference.linear, chooseStops(options, reference));
    std::optional<image::HdrFlip> hdr;
    if (bothHdr) hdr = hdrFlipWithProgress(test.linear, reference.linear);
    if (options.errorMap) image::writeErrorMap(options.errorMap->format(0), result.flipMap);
    if (options.hdrErrorMap) image::writeErrorMap(options.hdrErrorMap->format(0), hdr->map);
    if (result.invalidPixels > 0) {
        log::warn("{}: {} pixels are NaN or infinite; they count as the worst error", testFile.string(),
                  result.invalidPixels);
    }
    fmt::print("{}", options.json ? pictureJson(result, hdr) : pictureTable(result, hdr));
}

void runCompare(const Arguments& arguments) {
    const CompareOptions options = parse(arguments);
    if (options.test.numbered()) {
        compareSequence(options);
    } else {
        comparePictures(options);
    }
}

}  // namespace

void checkSameSize(const std::filesystem::path& file, const image::Image& picture,
                   const std::filesystem::path& otherFile, const image::Image& other) {
    if (picture.width == other.width && picture.height == other.height) return;
    throw InputError(file, fmt::format("is {}x{} pixels, but {} is {}x{}", picture.width, picture.height,
                                       otherFile.string(), other.width, other.height));
}

void checkReferenceFinite(const std::filesystem::path& file, const image::Image& reference) {
    size_t invalid = 0;
    for (const float value : reference.pixels) invalid += std::isfinite(value) ? 0 : 1;
    if (invalid == 0) return;
    throw InputError(file, fmt::format("has {} values that are NaN or infinite: no reference", invalid));
}

bool haveHdrFlip(const CompareOptions& options, const std::filesystem::path& testFile,
                 const image::Picture& test, const std::filesystem::path& referenceFile,
                 const image::Picture& reference) {
    if (test.sceneReferred && reference.sceneReferred) return true;
    if (options.hdrErrorMap) {
        throw UsageError(
            fmt::format("--hdr-error-map: HDR-FLIP is of EXR and HDR pictures, and {} is neither",
                        (test.sceneReferred ? referenceFile : testFile).string()));
    }
    return false;
}

void addCompareCommand(CLI::App& app) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command =
        app.add_subcommand("compare", "Measure the error of pictures or sequences against a reference");
    command
        ->add_option("TEST", arguments->test,
                     "Picture to measure: EXR, HDR, PFM, PNG or JPEG; or a sequence, as in test.%04d.exr")
        ->required();
    command
        ->add_option("REFERENCE", arguments->reference,
                     "Picture to compare with: any of these formats, same size. For a sequence: a sequence "
                     "of the same frames, or one picture for all")
        ->required();
    command->add_flag(
        "--json", arguments->json,
        "Print one JSON object: psnr (dB; null for equal pictures, where it is infinite), ssim, "
        "relmse, flip, hdr_flip (null unless both are EXR, HDR or PFM), exposure (stops), width, height, "
        "invalid_pixels. For a sequence: frames (an array of these, flicker and temporal_error), "
        "mean, worst");
    command->add_option("--error-map", arguments->errorMap,
                        "Write the FLIP error of each pixel as PNG (magma: black 0, yellow 1); for a "
                        "sequence with %04d in the name");
    command->add_option("--hdr-error-map", arguments->hdrErrorMap,
                        "Write the HDR-FLIP error of each pixel as PNG, in the same way");
    command
        ->add_option("--exposure", arguments->exposure,
                     "Exposure, stops, before psnr, ssim, flip, flicker and temporal_error clamp to [0,1] "
                     "and encode as sRGB; 'auto' brings the reference's average luminance to 0.18 (of a "
                     "sequence: over all frames). Default: auto for an EXR, HDR or PFM reference, 0 for PNG "
                     "or JPEG. relmse and hdr_flip use unexposed linear values")
        ->type_name("STOPS|auto");
    command->footer(
        "psnr, ssim: higher is better; ssim uses luma and an 11x11 Gaussian window within the picture. flip: "
        "LDR-FLIP at 67 pixels per degree, 0 to 1, lower is better. hdr_flip: the maximum of flip over the "
        "exposures that the reference calls for. relmse: mean of (x-r)^2/(r^2+0.01). flicker: how much more "
        "the sequence changes from frame to frame, along the motion layer, than its reference does; its mean "
        "is over magnitudes. temporal_error: how much the error changes from frame to frame, along the "
        "motion layer. A NaN or infinite pixel counts as the worst error in TEST and is refused in "
        "REFERENCE. Write a percent sign in a file name as %%.");
    command->callback([arguments] { runCompare(*arguments); });
}

}  // namespace limpid::cli
