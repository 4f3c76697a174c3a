#include "shot/run/frame_writer.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "base/hash.h"
#include "image/io/png/png.h"
#include "image/tonemap.h"
#include "renderer/layers/picture_name.h"
#include "shot/run/keep_input.h"

namespace limpid::shot {
namespace {

namespace fs = std::filesystem;

constexpr const char* inputAttribute = "limpid.input";

/// Changes with the content of a frame's files and with what is done to them.
std::string identityOf(uint64_t content, const ShotJob& job) {
    Hash64 hash;
    hash.addValue(content);
    hash.add(job.settingsText);
    return hashText(hash.value());
}

/// --preserve and --strength.
void keepInput(FrameToWrite& frame, const ShotJob& job) {
    for (size_t i = 0; i < frame.pictures.size(); ++i) {
        const image::Image noisy = frame.maps[i].layers.at("beauty").evaluate(frame.file);
        std::vector<float>& beauty = frame.pictures[i].beauty;
        if (job.preserve > 0.0f) restoreDetail(beauty, noisy, job.preserve);
        if (job.strength < 1.0f) mix(beauty, noisy, job.strength);
        std::vector<float>& alpha = frame.pictures[i].alpha;
        if (alpha.empty() || job.strength == 1.0f) continue;
        const image::Image given = frame.maps[i].layers.at("alpha").evaluate(frame.file);
        for (size_t p = 0; p < alpha.size(); ++p)
            alpha[p] = given.pixels[p] + job.strength * (alpha[p] - given.pixels[p]);
    }
}

void writeFrame(const fs::path& path, FrameToWrite frame, const ShotJob& job) {
    if (job.strength < 1.0f || job.preserve > 0.0f) keepInput(frame, job);
    if (!isExr(path)) {
        image::Image picture(frame.file.width(), frame.file.height(), 3);
        for (size_t i = 0; i < picture.pixels.size(); ++i)
            picture.pixels[i] = frame.pictures.front().beauty[i / 3 * 4 + i % 3];
        const float stops = job.exposure.value_or(image::autoExposure(picture, frame.surfaces));
        return image::writePng(path, image::toBytes(image::tonemap(picture, stops)));
    }
    std::set<size_t> parts;
    for (size_t i = 0; i < frame.pictures.size(); ++i) {
        shareOut(frame.pictures[i]);
        parts.merge(replacePicture(frame.file, frame.maps[i], frame.pictures[i]));
        frame.pictures[i] = {};  // the file has it now
    }
    for (const size_t part : parts) {
        frame.file.setText(part, "limpid.denoiser", std::string(job.options.method->name));
        frame.file.setText(part, inputAttribute, identityOf(frame.content, job));
    }
    frame.file.write(path);
}

enum class OutputState { Missing, Complete, Other };

/// Complete if it says that it is of this input and these settings.
OutputState stateOf(int frame, const ShotJob& job) {
    const fs::path output = outputOf(job, frame);
    if (!fs::exists(output)) return OutputState::Missing;
    try {
        const image::ExrDocument file = image::ExrDocument::read(output);
        const std::string identity = identityOf(contentOf(inputOf(job, frame), frame, job.load), job);
        const bool complete =
            std::any_of(file.parts().begin(), file.parts().end(), [&](const image::ExrPart& part) {
                const auto text = part.texts.find(inputAttribute);
                return text != part.texts.end() && text->second == identity;
            });
        return complete ? OutputState::Complete : OutputState::Other;
    } catch (const InputError&) {
        return OutputState::Other;
    }
}

}  // namespace

void FrameWriter::write(int number, FrameToWrite frame) {
    finish();
    writing_ = std::async(std::launch::async,
                          [this, path = outputOf(job_, number), moved = std::move(frame)]() mutable {
                              writeFrame(path, std::move(moved), job_);
                          });
}

void FrameWriter::finish() {
    if (writing_.valid()) writing_.get();
}

std::vector<float> surfacesOf(const LoadedFrame& frame) {
    std::vector<float> result;
    if (frame.own) {
        for (size_t p = 0; p < frame.own->pixelCount(); ++p)
            result.push_back(frame.own->depth[4 * p + 1] > 0.0f ? 1.0f : 0.0f);
    } else if (const image::Image* const depth = frame.layers.front().find("depth")) {
        for (const float z : depth->pixels)
            result.push_back(z > 0.0f && z < frame.maps.front().encoding.farDepth ? 1.0f : 0.0f);
    }
    return result;
}

std::optional<size_t> firstIncomplete(const ShotJob& job, FrameReader& reader,
                                      const std::function<bool()>& goesOn) {
    for (size_t i = job.firstWritten; i < job.endWritten; ++i) {
        if (!goesOn()) return std::nullopt;
        const OutputState state = stateOf(job.frames[i], job);
        if (state == OutputState::Complete) continue;
        if (job.skipUnreadable && !reader.read(i, std::nullopt)) continue;
        // Where frames are denoised backwards, too, those before a frame that has changed show its old light.
        const size_t reach = job.bidirectional && state == OutputState::Other ? blockFrames + runUpFrames : 0;
        return std::max(i, job.firstWritten + reach) - reach;
    }
    return job.endWritten;
}

}  // namespace limpid::shot
