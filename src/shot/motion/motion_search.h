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

    static constexpr float uncertain = 1e10f;  ///< above Encoding::noMotion

  private:
    std::vector<GuideLevel> last_;
};

}  // namespace limpid::shot
