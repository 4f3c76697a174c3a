#include "shot/shot_frame.h"

#include <algorithm>
#include <cmath>

#include "base/layers/layer_table.h"
#include "shaders/common/scene_layout.h"
#include "shot/camera_solve.h"

namespace limpid::shot {
namespace {

using image::Image;

/// Half the horizontal angle of view that is supposed where nothing is known: 25 degrees.
constexpr float supposedTangent = 0.4663f;

vec2 onScreen(uint32_t x, uint32_t y, const ShotLayers& layers) {
    return {2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(layers.width) - 1.0f,
            1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(layers.height)};
}

/// Through a pixel's centre; its component along the camera's axis is 1.
vec3 rayOf(const CameraParams& camera, const vec2& at) {
    return camera.orthographic != 0 ? camera.forward
                                    : camera.forward + at.x * camera.right + at.y * camera.up;
}

vec3 startOf(const CameraParams& camera, const vec2& at) {
    return camera.orthographic != 0 ? camera.origin + at.x * camera.right + at.y * camera.up : camera.origin;
}

/// A camera with these axes (columns: right, up, towards the viewer).
CameraParams cameraWith(const mat3& axes, const vec3& eye, float tangent, const ShotLayers& layers) {
    const float ratio = static_cast<float>(layers.height) / static_cast<float>(layers.width);
    CameraParams camera{};
    camera.origin = eye;
    camera.forward = -axes[2];
    camera.right = axes[0] * tangent;
    camera.up = axes[1] * (tangent * ratio);
    camera.spread = 2.0f * tangent / static_cast<float>(layers.width);
    return camera;
}

mat3 axesOf(const CameraParams& camera) {
    const vec3 right = glm::normalize(camera.right), up = glm::normalize(camera.up);
    return {right, up, glm::cross(right, up)};
}

float luminance(const float* c) {
    return 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
}

vec3 vectorAt(const Image& image, size_t p) {
    return {image.pixels[3 * p], image.pixels[3 * p + 1], image.pixels[3 * p + 2]};
}

/// The file's values of a vector per pixel, times `scale`, of unit length where they are not 0.
Image scaledNormals(const Image& normals, const vec3& scale) {
    Image result = normals;
    for (size_t p = 0; 3 * p < result.pixels.size(); ++p) {
        const vec3 n = vectorAt(normals, p) * scale;
        const float length = glm::length(n);
        const vec3 unit = length > 0.0f && std::isfinite(length) ? n / length : vec3(0.0f);
        for (int c = 0; c < 3; ++c) result.pixels[3 * p + static_cast<size_t>(c)] = unit[c];
    }
    return result;
}

/// Previous position minus this one, pixels; none where the file has none.
std::optional<vec2> motionAt(const Image& motion, size_t p, const Encoding& encoding) {
    vec2 moved(motion.pixels[motion.components * p], motion.pixels[motion.components * p + 1]);
    if (!(std::abs(moved.x) < encoding.noMotion && std::abs(moved.y) < encoding.noMotion))
        return std::nullopt;
    moved *= encoding.motionScale;
    if (encoding.motionUnit == MotionUnit::Picture) moved *= vec2(motion.width, motion.height);
    return moved;
}

/// Along the ray; 0 where nothing is seen.
std::vector<float> distancesOf(const ShotLayers& layers, const Encoding& encoding,
                               const CameraParams& camera) {
    std::vector<float> result(size_t{layers.width} * layers.height);
    const Image* const depth = layers.find("depth");
    const Image* const normal = layers.find("normal");
    const Image* const mean = layers.find("distance");
    const Image* const alpha = layers.find("alpha");
    const bool planar = !depth || encoding.depthKind == DepthKind::Planar;
    const auto covers = [&](size_t p) { return !layers.isTransparent || alpha->pixels[p] > 0.0f; };
    for (uint32_t y = 0; y < layers.height; ++y) {
        for (uint32_t x = 0; x < layers.width; ++x) {
            const size_t p = size_t{y} * layers.width + x;
            float z = 1.0f;
            if (!covers(p)) continue;
            if (depth) {
                z = depth->pixels[p];
                if (!(z > 0.0f && z < encoding.farDepth)) {
                    // The sample of the depth missed, but others did not.
                    if (mean && layers.isTransparent && mean->pixels[p] < encoding.farDepth)
                        result[p] = std::max(mean->pixels[p] / alpha->pixels[p], 0.0f);
                    continue;
                }
            } else if (normal && normal->pixels[3 * p] == 0.0f && normal->pixels[3 * p + 1] == 0.0f &&
                       normal->pixels[3 * p + 2] == 0.0f) {
                continue;
            }
            const bool scaled = planar && camera.orthographic == 0;
            result[p] = scaled ? z * glm::length(rayOf(camera, onScreen(x, y, layers))) : z;
        }
    }
    return result;
}

/// Points of this frame whose motion is known, for a camera with this tangent.
std::vector<TrackedPoint> trackedPoints(const ShotLayers& layers, const Encoding& encoding, float tangent) {
    const CameraParams camera = cameraWith(mat3(1.0f), vec3(0.0f), tangent, layers);
    const std::vector<float> distances = distancesOf(layers, encoding, camera);
    const Image& motion = layers.images.at("motion");
    const vec2 plane(tangent, tangent * static_cast<float>(layers.height) / static_cast<float>(layers.width));
    const vec2 pixel = 2.0f * plane / vec2(layers.width, layers.height);
    std::vector<TrackedPoint> points;
    const uint32_t stride = std::max(1u, std::min(layers.width, layers.height) / 90u);
    for (uint32_t y = stride / 2; y < layers.height; y += stride) {
        for (uint32_t x = stride / 2; x < layers.width; x += stride) {
            const size_t p = size_t{y} * layers.width + x;
            const auto moved = motionAt(motion, p, encoding);
            if (!moved || !(distances[p] > 0.0f)) continue;
            const vec2 at = onScreen(x, y, layers) * plane;
            const vec3 ray(at, -1.0f);
            points.push_back(
                {ray * (distances[p] / glm::length(ray)), at + *moved * vec2(1.0f, -1.0f) * pixel});
        }
    }
    return points;
}

/// The normals in world space. A pixel at an edge has a mean of several normals, which is shorter than 1 and
/// fits none of its neighbours: it gets that of the neighbour at the most similar distance.
class Normals {
  public:
    Normals(const ShotLayers& layers, const LayerMap& map, const CameraParams& camera,
            const std::vector<float>& distance)
        : layers_(layers),
          distance_(distance),
          file_(layers.find("normal")),
          ids_(layers.find("id")),
          axes_(axesOf(camera)),
          scale_(map.encoding.normalScale),
          turned_(map.encoding.normalSpace == NormalSpace::Camera) {}

    vec3 at(size_t p) const {
        if (!file_) return axes_[2];
        const size_t from = isMixed(p) ? likestNeighbour(p) : p;
        const vec3 n = vectorAt(*file_, from) * scale_;
        const float length = glm::length(n);
        if (!(length > 0.0f && std::isfinite(length))) return axes_[2];
        return (turned_ ? axes_ * n : n) / length;
    }

  private:
    bool isMixed(size_t p) const {
        const float length = glm::length(vectorAt(*file_, p));
        return !(length > 0.98f);
    }

    size_t likestNeighbour(size_t p) const {
        const auto x = static_cast<int64_t>(p % layers_.width), y = static_cast<int64_t>(p / layers_.width);
        size_t best = p;
        float least = 0.05f * distance_[p];
        for (int64_t v = std::max<int64_t>(y - 1, 0); v <= std::min<int64_t>(y + 1, layers_.height - 1); ++v)
            for (int64_t u = std::max<int64_t>(x - 1, 0); u <= std::min<int64_t>(x + 1, layers_.width - 1);
                 ++u) {
                const auto q = static_cast<size_t>(v * layers_.width + u);
                const float away = std::abs(distance_[q] - distance_[p]);
                const bool same = !ids_ || ids_->pixels[q] == ids_->pixels[p];
                if (!same || away >= least || isMixed(q)) continue;
                least = away;
                best = q;
            }
        return best;
    }

    const ShotLayers& layers_;
    const std::vector<float>& distance_;
    const Image* file_;
    const Image* ids_;
    mat3 axes_;
    vec3 scale_;
    bool turned_;
};

void addGeometry(const ShotLayers& layers, const LayerMap& map, const CameraParams& camera,
                 const std::vector<float>& distance, denoise::HostFrame& frame) {
    const Normals normals(layers, map, camera, distance);
    for (size_t p = 0; p < distance.size(); ++p) {
        if (!(distance[p] > 0.0f)) continue;
        const vec3 n = normals.at(p);
        for (int c = 0; c < 3; ++c) frame.normal[4 * p + static_cast<size_t>(c)] = n[c];
        frame.depth[4 * p] = distance[p];
        frame.depth[4 * p + 1] = 1.0f;
    }
}

/// Where the layers go on behind smooth mirrors and glass, light is described by what is seen there.
void addSeen(const ShotLayers& layers, const LayerMap& map, denoise::HostFrame& frame) {
    const Image* const albedo = layers.find("seenAlbedo");
    const Image* const normal = layers.find("cameraNormal");
    const Image* const length = layers.find("distance");
    if (!albedo || !normal || !length || frame.albedoSpecular.empty()) return;
    const mat3 axes = axesOf(frame.camera);
    for (size_t p = 0; p < frame.pixelCount(); ++p) {
        // What is seen lies behind the surface, and the surface has hardly any diffuse light.
        const bool behind = frame.depth[4 * p] > 0.0f && length->pixels[p] > 1.02f * frame.depth[4 * p];
        const float* const diffuse = &frame.albedo[4 * p];
        const float* const specular = &frame.albedoSpecular[4 * p];
        if (!behind || luminance(diffuse) > 0.05f * luminance(specular)) continue;
        const vec3 n = vectorAt(*normal, p) * map.encoding.cameraNormalScale;
        const vec3 seen = glm::length(n) > 0.0f ? glm::normalize(axes * n) : vec3(0.0f);
        for (size_t c = 0; c < 3; ++c) {
            frame.albedoSpecular[4 * p + c] = albedo->pixels[3 * p + c];
            if (seen != vec3(0.0f)) frame.normal[4 * p + c] = seen[static_cast<int>(c)];
        }
    }
}

void addIds(const ShotLayers& layers, const std::vector<float>& distance, denoise::HostFrame& frame) {
    const Image* const ids = layers.find("id");
    for (size_t p = 0; p < distance.size(); ++p) {
        if (!(distance[p] > 0.0f)) continue;
        const float id = ids ? ids->pixels[p] : 0.0f;
        frame.ids[2 * p] = id >= 0.0f && id < 4e9f ? static_cast<uint32_t>(id) : 0u;
    }
}

void copyColor(const Image* from, std::vector<float>& to) {
    for (size_t p = 0; from && 4 * p < to.size(); ++p) std::copy_n(&from->pixels[3 * p], 3, &to[4 * p]);
}

/// True if the beauty is nearer to the sum of the layers with the background than to the sum without.
bool showsBackground(const ShotLayers& layers, const std::vector<float>& distance) {
    const Image* const background = layers.find("background");
    if (!background) return false;
    double with = 0.0, without = 0.0;
    for (size_t p = 0; p < distance.size(); ++p) {
        if (!(distance[p] > 0.0f)) continue;
        for (size_t i = 3 * p; i < 3 * p + 3; ++i) {
            double rest = static_cast<double>(layers.images.at("beauty").pixels[i]);
            for (const char* role : {"diffuse", "specular", "emission"})
                if (const Image* const layer = layers.find(role))
                    rest -= static_cast<double>(layer->pixels[i]);
            if (!std::isfinite(rest)) continue;
            without += std::abs(rest);
            with += std::abs(rest - static_cast<double>(background->pixels[i]));
        }
    }
    return with < without;
}

/// Where a transparent film is covered: light and albedo of the share that is covered.
void divideByAlpha(const ShotLayers& layers, const std::vector<float>& distance, denoise::HostFrame& frame) {
    const Image& alpha = layers.images.at("alpha");
    for (auto* texels :
         {&frame.diffuse, &frame.specular, &frame.emission, &frame.albedo, &frame.albedoSpecular})
        for (size_t i = 0; i < texels->size(); ++i)
            if (distance[i / 4] > 0.0f && i % 4 != 3) (*texels)[i] /= alpha.pixels[i / 4];
}

/// The distance in the previous frame at this position, of the nearest pixel; 0 outside.
float distanceAt(const std::vector<float>& distance, const ShotLayers& layers, const vec2& position) {
    const auto x = static_cast<int64_t>(std::floor(position.x + 0.5f));
    const auto y = static_cast<int64_t>(std::floor(position.y + 0.5f));
    if (x < 0 || y < 0 || x >= int64_t{layers.width} || y >= int64_t{layers.height}) return 0.0f;
    return distance[static_cast<size_t>(y) * layers.width + static_cast<size_t>(x)];
}

}  // namespace

ShotLayers readLayers(image::ExrDocument& file, const LayerMap& map) {
    ShotLayers layers;
    layers.width = file.width();
    layers.height = file.height();
    for (const auto& [role, expression] : map.layers) layers.images[role] = expression.evaluate(file);
    for (const LayerExpression& group : map.groups) layers.groups.push_back(group.evaluate(file));
    if (const Image* const alpha = layers.find("alpha"))
        layers.isTransparent = std::any_of(alpha->pixels.begin(), alpha->pixels.end(),
                                           [](float share) { return share < 0.999f; });
    return layers;
}

std::optional<CameraParams> FrameConverter::locatedCamera(const ShotLayers& layers) const {
    const Image* const position = layers.find("position");
    const Image* const depth = layers.find("depth");
    if (!position || !depth || map_.encoding.depthKind != DepthKind::Planar) return std::nullopt;
    const auto view = viewFromPositions(*position, *depth, map_.encoding.farDepth);
    if (!view) return std::nullopt;
    CameraParams camera{};
    camera.origin = view->eye;
    camera.forward = view->forward;
    camera.right = view->right;
    camera.up = view->up;
    camera.spread = 2.0f * glm::length(view->right) / static_cast<float>(layers.width);
    return camera;
}

CameraParams FrameConverter::solvedCamera(const ShotLayers& layers) {
    report_.camera = CameraSource::Solved;
    if (const auto located = locatedCamera(layers)) return *located;
    const Image* const depth = layers.find("depth");
    const Image* const distance = layers.find("distance");
    const Image* const world = layers.find("normal");
    const Image* const inCamera = layers.find("cameraNormal");
    std::optional<float> tangent;
    if (depth && distance && map_.encoding.depthKind == DepthKind::Planar)
        tangent = horizontalTangent(*distance, *depth, map_.encoding.farDepth);
    if (!tangent && last_ && last_->comparable) tangent = glm::length(last_->camera.right);
    if (!tangent) report_.camera = CameraSource::Supposed;
    const float t = tangent.value_or(supposedTangent);
    std::optional<mat3> turn;
    if (inCamera && world && map_.encoding.normalSpace == NormalSpace::World)
        turn = rotationBetween(scaledNormals(*inCamera, map_.encoding.cameraNormalScale),
                               scaledNormals(*world, map_.encoding.normalScale));
    const mat3 before = last_ ? axesOf(last_->camera) : mat3(1.0f);
    const vec3 eye = last_ ? last_->camera.origin : vec3(0.0f);
    const mat3 axes = turn.value_or(before);
    if (!depth || !layers.find("motion") || !continues_) return cameraWith(axes, eye, t, layers);
    const auto move = cameraMove(trackedPoints(layers, map_.encoding, t),
                                 0.5f * t / static_cast<float>(layers.width), glm::transpose(before) * axes);
    if (!move) {
        report_.camera = CameraSource::Supposed;
        return cameraWith(axes, eye, t, layers);
    }
    report_.inliers = move->inliers;
    return cameraWith(turn ? axes : before * move->rotation, eye + before * move->translation, t, layers);
}

CameraParams FrameConverter::cameraOf(const ShotLayers& layers, const std::optional<CameraParams>& given) {
    report_.inliers = 0.0f;
    report_.camera = CameraSource::Given;
    if (given) return *given;
    return layers.camera ? *layers.camera : solvedCamera(layers);
}

void FrameConverter::addLight(const ShotLayers& layers, const std::vector<float>& distance,
                              denoise::HostFrame& frame) {
    const Image& beauty = layers.images.at("beauty");
    const Image* const diffuse = layers.find("diffuse");
    const Image* const specular = layers.find("specular");
    const Image* const emission = layers.find("emission");
    const bool two = diffuse && specular;
    const Image* const background = showsBackground(layers, distance) ? layers.find("background") : nullptr;
    double rest = 0.0, all = 0.0;
    for (size_t p = 0; p < distance.size(); ++p) {
        const float* const total = &beauty.pixels[3 * p];
        if (!(distance[p] > 0.0f)) {  // what is behind everything is not filtered
            std::copy_n(total, 3, &frame.emission[4 * p]);
            continue;
        }
        float left[3];
        for (size_t c = 0; c < 3; ++c) {
            const float own = (emission ? emission->pixels[3 * p + c] : 0.0f) +
                              (background ? background->pixels[3 * p + c] : 0.0f);
            frame.emission[4 * p + c] = own;
            left[c] = total[c] - own;
            if (!two) {
                frame.diffuse[4 * p + c] = left[c];
                continue;
            }
            frame.diffuse[4 * p + c] = diffuse->pixels[3 * p + c];
            // With what no layer has: volumes, for example. The sum stays the beauty.
            frame.specular[4 * p + c] = left[c] - diffuse->pixels[3 * p + c];
            left[c] = frame.specular[4 * p + c] - specular->pixels[3 * p + c];
        }
        const double energy = std::abs(static_cast<double>(luminance(total)));
        const double unexplained = std::abs(static_cast<double>(luminance(left)));
        if (two && std::isfinite(energy) && std::isfinite(unexplained)) {
            all += energy;
            rest += std::min(unexplained, energy);
        }
    }
    report_.lightShare = all > 0.0 ? 1.0 - rest / all : 1.0;
}

void FrameConverter::addMotion(const ShotLayers& layers, const View& view, denoise::HostFrame& frame) const {
    const Image* const motion = layers.find("motion");
    if (!motion) return;
    for (uint32_t y = 0; y < layers.height; ++y) {
        for (uint32_t x = 0; x < layers.width; ++x) {
            const size_t p = size_t{y} * layers.width + x;
            const auto moved = motionAt(*motion, p, map_.encoding);
            if (!moved || !(view.distance[p] > 0.0f)) continue;
            float before = view.distance[p];
            if (!alone_) {
                // Of a point that stands still; else of what the previous frame shows there.
                const vec2 at = onScreen(x, y, layers);
                const vec3 ray = rayOf(frame.camera, at);
                const vec3 point = startOf(frame.camera, at) + ray * (before / glm::length(ray));
                const bool knows = view.comparable && last_->comparable && frame.camera.orthographic == 0;
                before = knows ? glm::length(point - last_->camera.origin)
                               : distanceAt(last_->distance, layers, vec2(x, y) + *moved);
            }
            const float texel[] = {moved->x, moved->y, before - view.distance[p], 1.0f};
            std::copy_n(texel, 4, &frame.motion[4 * p]);
        }
    }
}

denoise::HostFrame FrameConverter::convertAlone(const ShotLayers& layers,
                                                const std::optional<CameraParams>& given) {
    alone_ = true;
    denoise::HostFrame frame = convert(layers, given, false);
    alone_ = false;
    return frame;
}

denoise::HostFrame FrameConverter::convert(const ShotLayers& layers, const std::optional<CameraParams>& given,
                                           bool continues) {
    continues_ = continues && last_ && last_->distance.size() == size_t{layers.width} * layers.height;
    denoise::HostFrame frame;
    frame.width = layers.width;
    frame.height = layers.height;
    frame.camera = cameraOf(layers, given);
    const bool two = layers.find("diffuse") && layers.find("specular");
    frame.forEach([&](const LayerInfo& layer, auto& texels) {
        const bool ofSpecular = layer.member == "specular" || layer.member == "albedoSpecular";
        const bool unknown = layer.member == "hitDistance" || layer.member == "roughness" ||
                             layer.member == "reflectionMotion";
        if (unknown || (ofSpecular && !two)) return;
        const bool integers = layer.stored == Stored::Uint;
        texels.resize((integers ? 2 : 4) * frame.pixelCount());
        if (integers) std::fill(texels.begin(), texels.end(), layout::NONE);
    });
    View view{frame.camera, distancesOf(layers, map_.encoding, frame.camera),
              report_.camera != CameraSource::Supposed};
    addLight(layers, view.distance, frame);
    addGeometry(layers, map_, frame.camera, view.distance, frame);
    addIds(layers, view.distance, frame);
    copyColor(layers.find("albedo"), frame.albedo);
    if (!layers.find("albedo")) std::fill(frame.albedo.begin(), frame.albedo.end(), 1.0f);
    if (two) copyColor(layers.find("albedoSpecular"), frame.albedoSpecular);
    if (two && !layers.find("albedoSpecular"))
        std::fill(frame.albedoSpecular.begin(), frame.albedoSpecular.end(), 1.0f);
    if (layers.isTransparent) divideByAlpha(layers, view.distance, frame);
    if (const Image* const roughness = layers.find("roughness"); roughness && two) {
        frame.roughness.resize(4 * frame.pixelCount());
        for (size_t p = 0; p < frame.pixelCount(); ++p) frame.roughness[4 * p] = roughness->pixels[p];
    }
    addSeen(layers, map_, frame);
    frame.previousNormal = frame.normal;  // files do not tell how surfaces turn
    if (continues_ || alone_) addMotion(layers, view, frame);
    report_.horizontalFov = frame.camera.orthographic != 0
                                ? 0.0f
                                : glm::degrees(2.0f * std::atan(glm::length(frame.camera.right)));
    last_ = std::move(view);
    return frame;
}

}  // namespace limpid::shot
