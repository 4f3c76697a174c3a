#include "shot/run/cut_finder.h"

#include <algorithm>

#include "shot/motion_check.h"

namespace limpid::shot {
namespace {

/// Into memory that is there from the frame before.
void copyGuides(const ShotLayers& from, ShotLayers& to) {
    to.width = from.width;
    to.height = from.height;
    for (const char* role : {"albedo", "normal", "motion"}) {
        if (const image::Image* const image = from.find(role))
            to.images[role] = *image;
        else
            to.images.erase(role);
    }
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
    const ShotLayers& now = frame.layers.front();
    const Encoding& encoding = frame.maps.front().encoding;
    const bool forwards = before < number_;
    const bool cut =
        last_ && (forwards ? shot::isCut(*last_, now, encoding) : shot::isCut(now, *last_, encoding));
    if (!last_) last_.emplace();
    copyGuides(now, *last_);
    return cut;
}

}  // namespace limpid::shot
