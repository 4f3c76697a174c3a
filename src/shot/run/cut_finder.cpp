#include "shot/run/cut_finder.h"

#include <algorithm>

#include "shot/motion_check.h"

namespace limpid::shot {
namespace {

ShotLayers guidesOf(const ShotLayers& layers) {
    ShotLayers guides;
    guides.width = layers.width;
    guides.height = layers.height;
    for (const char* role : {"albedo", "normal", "motion"})
        if (const image::Image* const image = layers.find(role)) guides.images[role] = *image;
    return guides;
}

}  // namespace

bool CutFinder::isCut(const LoadedFrame& frame) {
    const int before = number_;
    number_ = frame.number;
    if (job_.cuts == Cuts::Given) {
        const int later = std::max(before, number_);
        return std::find(job_.cutFrames.begin(), job_.cutFrames.end(), later) != job_.cutFrames.end();
    }
    if (frame.layers.empty()) return false;  // Limpid's files mark cuts in their motion
    ShotLayers now = guidesOf(frame.layers.front());
    const Encoding& encoding = frame.maps.front().encoding;
    const bool forwards = before < number_;
    const bool cut =
        last_ && (forwards ? shot::isCut(*last_, now, encoding) : shot::isCut(now, *last_, encoding));
    last_ = std::move(now);
    return cut;
}

}  // namespace limpid::shot
