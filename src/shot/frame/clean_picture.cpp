#include "shot/frame/clean_picture.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace limpid::shot {
namespace {

void checkReplaceable(const image::ExrDocument& file, const LayerExpression& expression) {
    if (!isReplaceable(file, expression))
        throw UsageError(fmt::format("'{}' is no layer of {} that could be replaced", expression.text(),
                                     file.name().string()));
}

/// Replaces a layer. Adds the parts that changed.
void replaceLayer(image::ExrDocument& file, const LayerExpression& expression,
                  const std::vector<float>& colors, std::set<size_t>& parts) {
    const std::vector<ChannelPlace>& channels = expression.terms().front().factors.front().channels;
    std::vector<float> values(colors.size() / 4);
    for (size_t c = 0; c < channels.size(); ++c) {
        for (size_t p = 0; p < values.size(); ++p) values[p] = colors[4 * p + c];
        file.replace(channels[c].part, channels[c].channel, values);
        parts.insert(channels[c].part);
    }
}

}  // namespace

void merge(CleanPicture& forwards, const CleanPicture& backwards) {
    if (forwards.frames.empty() || backwards.frames.size() != forwards.frames.size()) return;
    for (size_t p = 0; p < forwards.frames.size(); ++p) {
        const float before = std::max(forwards.frames[p], 0.0f), after = std::max(backwards.frames[p], 0.0f);
        if (!(before + after > 0.0f)) continue;
        const float share = after / (before + after);
        for (size_t c = 4 * p; c < 4 * p + 3; ++c)
            forwards.beauty[c] += share * (backwards.beauty[c] - forwards.beauty[c]);
        if (!forwards.alpha.empty() && !backwards.alpha.empty())
            forwards.alpha[p] += share * (backwards.alpha[p] - forwards.alpha[p]);
    }
}

bool isReplaceable(const image::ExrDocument& file, const LayerExpression& expression) {
    bool single = expression.terms().size() == 1 && expression.terms().front().scale == 1.0f &&
                  expression.terms().front().factors.size() == 1;
    for (const ChannelPlace& place : expression.places())
        single = single && !file.parts()[place.part].attached;
    return single;
}

void checkReplaceable(const image::ExrDocument& file, const LayerMap& map) {
    checkReplaceable(file, map.target());
    for (const LayerExpression& group : map.groups) checkReplaceable(file, group);
}

void shareOut(CleanPicture& picture) {
    for (size_t i = 0; i < picture.beauty.size() && !picture.groups.empty(); ++i) {
        float sum = 0.0f;
        for (const std::vector<float>& group : picture.groups) sum += group[i];
        const float scale = sum > 0.0f ? picture.beauty[i] / sum : 0.0f;
        for (std::vector<float>& group : picture.groups) group[i] *= scale;
        if (!(sum > 0.0f)) picture.groups.back()[i] = picture.beauty[i];
    }
}

std::set<size_t> replacePicture(image::ExrDocument& file, const LayerMap& map, const CleanPicture& picture) {
    std::set<size_t> parts;
    replaceLayer(file, map.target(), picture.beauty, parts);
    if (!picture.alpha.empty()) {
        std::vector<float> texels(4 * picture.alpha.size());
        for (size_t p = 0; p < picture.alpha.size(); ++p) texels[4 * p] = picture.alpha[p];
        replaceLayer(file, map.layers.at("alpha"), texels, parts);
    }
    for (size_t g = 0; g < map.groups.size() && g < picture.groups.size(); ++g)
        replaceLayer(file, map.groups[g], picture.groups[g], parts);
    return parts;
}

}  // namespace limpid::shot
