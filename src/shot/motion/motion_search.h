// Motion for shots whose files have none, found on albedo, normals and depth.
#pragma once

#include <optional>
#include <vector>

#include "image/image.h"
#include "shot/frame/shot_frame.h"
#include "shot/motion/guide_pyramid.h"

namespace limpid::shot {

/// Searches the motion between the frames of one picture of a shot.
class MotionSearch {
  public:
    /// Returns, for each pixel of these layers, where its surface was in the frame of the last call minus
    /// where it is: two components, pixels, x right, y down. Where it is uncertain, they are `uncertain`: the
    /// pixel has left the picture, was hidden, or motion there and back do not agree. None if there was no
    /// call before, `continues` is false, the frames differ in size, or there is neither albedo nor normal.
    /// Frames that are equal have no motion.
    std::optional<image::Image> next(const ShotLayers& layers, bool continues);

    /// For layers with ShotLayers::zeroMotion, which is right if nothing moves: puts the zeros back, until
    /// two frames differ in a way that found motion explains; from then on, what next() finds, in the file's
    /// encoding, and ShotLayers::problems tells of it.
    void replaceZero(ShotLayers& layers, const Encoding& encoding, bool continues);

    static constexpr float uncertain = 1e10f;  ///< above Encoding::noMotion

  private:
    image::Image search(const std::vector<GuideLevel>& before) const;

    std::vector<GuideLevel> last_;
    bool moves_ = false;  ///< replaceZero() has seen something move
};

}  // namespace limpid::shot
