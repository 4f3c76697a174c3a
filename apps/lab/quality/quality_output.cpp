#include "lab/quality/quality_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "cli/console/json_text.h"
#include "image/io/png/png.h"
#include "image/tonemap.h"
#include "lab/quality/report/picture_label.h"
#include "lab/quality/report/quality_json.h"
#include "lab/quality/report/quality_page.h"
#include "lab/quality/report/quality_table.h"

namespace limpid::cli {
namespace {

/// What is said inside a strip about one of its pictures: two lines, for the frame that is shown.
std::vector<std::string> labelOf(const MethodQuality& method, uint32_t samples) {
    const image::FrameScores& scores = method.scores.back();
    return {fmt::format("{}, {} spp", method.name, samples),
            fmt::format("{:.1f} dB FLIP {:.3f}", scores.psnr, scores.flip)};
}

/// Writes the noisy frame, every method and the reference side by side, with labels.
void writeSideBySide(const std::filesystem::path& file, const MeasuredSequence& measured, uint32_t samples) {
    const SequenceQuality& quality = measured.quality;
    std::vector<const image::Image*> pictures;
    for (const MethodQuality& method : quality.methods) pictures.push_back(&method.last);
    pictures.push_back(&quality.reference);
    const uint32_t width = quality.reference.width, height = quality.reference.height;
    image::Image all(width * static_cast<uint32_t>(pictures.size()), height, 3);
    for (size_t i = 0; i < pictures.size(); ++i) {
        for (uint32_t y = 0; y < height; ++y) {
            std::copy_n(&pictures[i]->pixels[size_t{3} * y * width], 3 * width,
                        &all.pixels[size_t{3} * (size_t{y} * all.width + i * width)]);
        }
    }
    image::ByteImage bytes = image::toBytes(image::tonemap(all, quality.exposure));
    for (uint32_t i = 0; i < pictures.size(); ++i) {
        const std::vector<std::string> label =
            i < quality.methods.size()
                ? labelOf(quality.methods[i], samples)
                : std::vector{std::string("reference"),
                              fmt::format("{} spp", measured.sequence.referenceSamples)};
        drawLabel(bytes, {i * width, 0, width, height}, label);
    }
    image::writePng(file, bytes);
}

}  // namespace

QualityOutput::QualityOutput(QualityRun head, size_t count, QualityDestinations destinations)
    : run_(std::move(head)), to_(std::move(destinations)), waiting_(count) {
    if (!to_.json) printHead(run_);
}

void QualityOutput::add(size_t index, QualityOutcome outcome) {
    waiting_.at(index) = std::move(outcome);
    for (; shown_ < waiting_.size() && waiting_[shown_]; ++shown_)
        show(*std::exchange(waiting_[shown_], std::nullopt));
}

void QualityOutput::show(QualityOutcome outcome) {
    if (auto* const skipped = std::get_if<SkippedSequence>(&outcome)) {
        log::warn("SKIPPED: {}: {}", skipped->name, skipped->reason);
        run_.skipped.push_back(std::move(*skipped));
        return;
    }
    run_.sequences.push_back(std::get<MeasuredSequence>(std::move(outcome)));
    const MeasuredSequence& measured = run_.sequences.back();
    if (!to_.json) printSequence(measured);
    if (!to_.folder.empty()) {
        const std::filesystem::path folder(to_.folder);
        writeSideBySide(folder / ("quality." + measured.sequence.name + ".png"), measured, run_.samples);
    }
    if (!to_.report.empty()) writeQualityPage(to_.report, run_);
}

void QualityOutput::finish() {
    if (run_.sequences.empty()) throw Error("no sequence could be measured");
    if (!to_.report.empty()) writeQualityPage(to_.report, run_);  // once more, including skipped sequences
    if (!to_.json && run_.sequences.size() > 1) printRanking(run_);
    if (to_.json) fmt::print("{}\n", jsonText(qualityJson(run_)));
}

}  // namespace limpid::cli
