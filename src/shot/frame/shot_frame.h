// Makes frames for denoisers of a shot's files.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "denoise/api/host_frame.h"
#include "image/io/exr/exr_document.h"
#include "shot/camera/camera_track.h"
#include "shot/layers/layer_map.h"

namespace limpid::shot {

/// The layers of one picture of a file, decoded, in the file's encoding.
struct ShotLayers {
    uint32_t width = 0, height = 0;
    float pixelAspect = 1.0f;  ///< a pixel's width over its height
    /// The film is transparent: light and albedo are multiplied by alpha, which is below 0.999 in at least
    /// one of a thousand pixels. Fewer are holes or noise; then the frame is treated as opaque.
    bool isTransparent = false;
    bool showsSky = false;  ///< behind the film, which is not transparent for that reason
    std::map<std::string, image::Image, std::less<>> images;  ///< by role
    std::optional<CameraParams> camera;                       ///< of the file's attributes
    uint32_t samples = 0;                                     ///< per pixel; 0: unknown
    std::vector<image::Image> groups;                         ///< of light
    /// The file's motion vectors are all 0, so `images` has no motion: nothing moves, or the renderer wrote
    /// none (Blender with motion blur).
    bool zeroMotion = false;
    bool motionSearched = false;        ///< `images` has motion that was found instead; see MotionSearch
    std::vector<std::string> problems;  ///< why layers of the file are not used, for the user

    const image::Image* find(std::string_view role) const {
        const auto found = images.find(role);
        return found == images.end() ? nullptr : &found->second;
    }
};

/// Decodes the parts that the map's layers lie in.
void decodeParts(image::ExrDocument& file, const LayerMap& map);
/// Leaves out layers that say nothing: motion that is 0 everywhere (ShotLayers::zeroMotion), and depth
/// without a value above 0 (ShotLayers::problems), unless other layers tell that only the sky is seen: the
/// normals are 0 everywhere; without them albedo, diffuse and specular light; without those, alpha.
ShotLayers readLayers(image::ExrDocument& file, const LayerMap& map);
/// Believes vectors that are all 0: puts them back.
void restoreZeroMotion(ShotLayers& layers);

/// Where a frame's camera is from.
enum class CameraSource {
    Given,     ///< from a file of cameras, or the frame's attributes
    Solved,    ///< from positions, depth, normals and motion
    Supposed,  ///< nothing is known: an angle of 50 degrees, and no movement
};

/// What is known of a frame's view, for messages.
struct FrameReport {
    CameraSource camera = CameraSource::Supposed;
    float inliers = 0.0f;         ///< of a solved movement: the share of points that agree
    float horizontalFov = 0.0f;   ///< degrees; 0 for an orthographic camera
    double lightShare = 1.0;      ///< of the beauty's energy: what diffuse, specular and emission explain
    uint64_t notFinite = 0;       ///< pixels whose beauty is NaN or infinite
    bool motionSearched = false;  ///< ShotLayers::motionSearched
    std::vector<std::string> problems;  ///< for the user; the same texts for each frame with such a problem
};

class MotionSearch;

/// Converts the frames of one picture of a shot, in order.
class FrameConverter {
  public:
    explicit FrameConverter(LayerMap map);
    ~FrameConverter();

    /// `given`: the camera, if it is known otherwise. `continues`: the last frame that was converted is the
    /// one before; else all motion is invalid. Missing layers become what the denoisers take for missing:
    /// without specular light, all light is one signal; without normals, surfaces face the viewer; without
    /// depth, all lie on a plane; without albedo, it is white. On transparent film, light and albedo are
    /// divided by alpha, so that coverage is no noise: multiply the clean picture by it.
    denoise::HostFrame convert(const ShotLayers& layers, const std::optional<CameraParams>& given,
                               bool continues);

    /// The same for frames in any order: motion has no difference of distances, and it is kept although no
    /// frame came before. A camera that only a shot in order tells stands still. The motion of reflections
    /// is that from the frame that was converted last, if `continues`.
    denoise::HostFrame convertAlone(const ShotLayers& layers, const std::optional<CameraParams>& given,
                                    bool continues);

    /// convert(), or convertAlone() if `alone`, for frames whose layers nobody else needs: frees all but the
    /// beauty and alpha, those of light before those of geometry are made. If the motion is 0 everywhere
    /// although the picture changes, it is searched: it then leads to the frame of the last call, also if
    /// `alone` (FrameReport::motionSearched). Light that is not filtered becomes finite in the layers, too.
    /// Once the film was transparent, that of frames that continue is, too (ShotLayers::isTransparent).
    denoise::HostFrame convertUsingUp(ShotLayers& layers, const std::optional<CameraParams>& given,
                                      bool continues, bool alone);

    const FrameReport& report() const { return report_; }

  private:
    struct View {
        CameraParams camera{};
        std::vector<float> distance;  ///< along the ray; 0 where nothing is seen
        bool comparable = false;      ///< the camera stands in the same space as the last frame's
    };
    CameraParams cameraOf(const ShotLayers& layers, const std::optional<CameraParams>& given);
    std::optional<CameraParams> locatedCamera(const ShotLayers& layers) const;
    CameraParams solvedCamera(const ShotLayers& layers);
    void addMotion(const ShotLayers& layers, const View& view, denoise::HostFrame& frame) const;
    void replaceZeroMotion(ShotLayers& layers, bool continues);
    void continueFilm(ShotLayers& layers, bool continues);

    LayerMap map_;
    FrameReport report_;
    std::optional<View> last_;
    bool continues_ = false;
    bool alone_ = false, reflects_ = false;
    bool wasTransparent_ = false;           ///< the film, in the last call of convertUsingUp()
    ShotLayers* used_ = nullptr;            ///< in convertUsingUp()
    std::unique_ptr<MotionSearch> search_;  ///< while vectors are all 0
};

}  // namespace limpid::shot
