#include "shot/frame/shot_frame.h"

#include <fmt/format.h>
#include <tbb/parallel_for_each.h>

#include <algorithm>
#include <cmath>

#include "base/layers/layer_table.h"
#include "shaders/common/scene_layout.h"
#include "shot/camera/camera_solve.h"
#include "shot/estimate/emitters.h"
#include "shot/estimate/reflection_motion.h"
#include "shot/frame/pixel_layers.h"
#include "shot/motion/motion_search.h"

namespace limpid::shot {
namespace {

using image::Image;

/// Half the horizontal angle of view that is supposed where nothing is known: 25 degrees.
constexpr float supposedTangent = 0.4663f;

/// Where the file does not tell: those that networks were trained with.
constexpr uint32_t supposedSamples = 32;

/// Of the picture: its height over its width.
float ratioOf(const ShotLayers& layers) {
    return static_cast<float>(layers.height) / (static_cast<float>(layers.width) * layers.pixelAspect);
}

/// A camera with these axes (columns: right, up, towards the viewer).
CameraParams cameraWith(const mat3& axes, const vec3& eye, float tangent, const ShotLayers& layers) {
    CameraParams camera{};
    camera.origin = eye;
    camera.forward = -axes[2];
    camera.right = axes[0] * tangent;
    camera.up = axes[1] * (tangent * ratioOf(layers));
    camera.spread = 2.0f * tangent / static_cast<float>(layers.width);
    return camera;
}

/// Points of this frame whose motion is known, for a camera with this tangent.
std::vector<TrackedPoint> trackedPoints(const ShotLayers& layers, const Encoding& encoding, float tangent) {
    const CameraParams camera = cameraWith(mat3(1.0f), vec3(0.0f), tangent, layers);
    const std::vector<float> distances = distancesOf(layers, encoding, camera);
    const Image& motion = layers.images.at("motion");
    const vec2 plane(tangent, tangent * ratioOf(layers));
    const vec2 pixel = 2.0f * plane / vec2(layers.width, layers.height);
    std::vector<TrackedPoint> points;
    const uint32_t stride = std::max(1u, std::min(layers.width, layers.height) / 90u);
    for (uint32_t y = stride / 2; y < layers.height; y += stride) {
        for (uint32_t x = stride / 2; x < layers.width; x += stride) {
            const size_t p = size_t{y} * layers.width + x;
            const auto moved = motionAt(motion, p, encoding);
            if (!moved || !(distances[p] > 0.0f)) continue;
            const vec2 at = onScreen(p, layers) * plane;
            const vec3 ray(at, -1.0f);
            points.push_back(
                {ray * (distances[p] / glm::length(ray)), at + *moved * vec2(1.0f, -1.0f) * pixel});
        }
    }
    return points;
}

/// The distance in the previous frame at this position, of the nearest pixel; 0 outside.
float distanceAt(const std::vector<float>& distance, const ShotLayers& layers, const vec2& position) {
    const auto x = static_cast<int64_t>(std::floor(position.x + 0.5f));
    const auto y = static_cast<int64_t>(std::floor(position.y + 0.5f));
    if (x < 0 || y < 0 || x >= int64_t{layers.width} || y >= int64_t{layers.height}) return 0.0f;
    return distance[static_cast<size_t>(y) * layers.width + static_cast<size_t>(x)];
}

/// What is behind everything is not filtered, and neither are lamps.
void hideEmitters(const ShotLayers& layers, std::vector<float>& distance) {
    const SurfaceGuides guides{layers.find("albedo"), layers.find("normal"), layers.find("id")};
    const std::vector<uint8_t> emits = findEmitters(layers.images.at("beauty"), distance, guides);
    for (size_t p = 0; p < emits.size(); ++p)
        if (emits[p]) distance[p] = 0.0f;
}

/// Whether a layer is light or the albedo that was multiplied in.
bool isLight(const LayerInfo& layer) {
    return layer.inBeauty || layer.member == "albedo" || layer.member == "albedoSpecular";
}

void makeLight(denoise::HostFrame& frame, bool separate) {
    for (const LayerInfo& layer : frameLayers) {
        const bool ofSpecular = layer.member == "specular" || layer.member == "albedoSpecular";
        if (isLight(layer) && (separate || !ofSpecular)) frame[layer].resize(4 * frame.pixelCount());
    }
}

void makeGeometry(denoise::HostFrame& frame) {
    frame.forEach([&](const LayerInfo& layer, auto& texels) {
        const bool unknown = layer.member == "hitDistance" || layer.member == "roughness" ||
                             layer.member == "reflectionMotion";
        const bool copied = layer.member == "previousNormal";
        if (unknown || copied || isLight(layer)) return;
        const bool integers = layer.stored == Stored::Uint;
        texels.resize((integers ? 2 : 4) * frame.pixelCount());
        if (integers) std::fill(texels.begin(), texels.end(), layout::NONE);
    });
}

void freeRoles(ShotLayers& layers, std::initializer_list<const char*> which) {
    for (const char* role : which) layers.images.erase(role);
}

bool isZero(const Image& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](float value) { return value == 0.0f; });
}

/// Whether other layers than the depth tell that the frame shows the sky alone.
bool isSky(const ShotLayers& layers) {
    if (const Image* const normal = layers.find("normal")) return isZero(*normal);
    bool isKnown = false;
    for (const char* role : {"albedo", "albedoSpecular", "diffuse", "specular"}) {
        const Image* const image = layers.find(role);
        if (image && !isZero(*image)) return false;
        isKnown = isKnown || image;
    }
    const Image* const alpha = layers.find("alpha");
    return isKnown || (alpha && isZero(*alpha));
}

/// A depth that is nowhere above 0 would make all pixels background, which is not denoised.
void dropEmptyDepth(ShotLayers& layers) {
    const Image* const depth = layers.find("depth");
    if (!depth) return;
    if (std::any_of(depth->pixels.begin(), depth->pixels.end(), [](float z) { return z > 0.0f; })) return;
    if (isSky(layers)) return;
    layers.images.erase("depth");
    layers.problems.push_back(fmt::format(
        "the layer 'depth' has no value above 0, so it is taken as missing: {}", findRole("depth")->without));
}

bool isFilmTransparent(const Image& alpha) {
    const auto uncovered = static_cast<size_t>(
        std::count_if(alpha.pixels.begin(), alpha.pixels.end(), [](float share) { return share < 0.999f; }));
    return uncovered > 0 && 1000 * uncovered >= alpha.pixels.size();
}

void dropZeroMotion(ShotLayers& layers) {
    const Image* const motion = layers.find("motion");
    if (!motion || !isZero(*motion)) return;
    layers.images.erase("motion");
    layers.zeroMotion = true;
}

}  // namespace

void decodeParts(image::ExrDocument& file, const LayerMap& map) {
    const auto decode = [&](const LayerExpression& expression) {
        for (const Term& term : expression.terms())
            for (const Factor& factor : term.factors)
                for (const ChannelPlace& place : factor.channels) file.decode(place.part);
    };
    for (const auto& [role, expression] : map.layers) decode(expression);
    for (const LayerExpression& group : map.groups) decode(group);
}

ShotLayers readLayers(image::ExrDocument& file, const LayerMap& map) {
    ShotLayers layers;
    layers.width = file.width();
    layers.height = file.height();
    layers.pixelAspect = file.pixelAspect();
    layers.groups.resize(map.groups.size());
    std::vector<std::pair<const LayerExpression*, Image*>> wanted;
    for (const auto& [role, expression] : map.layers) wanted.emplace_back(&expression, &layers.images[role]);
    for (size_t g = 0; g < map.groups.size(); ++g) wanted.emplace_back(&map.groups[g], &layers.groups[g]);
    // Parts are decoded when they are first used, which is not for several threads.
    decodeParts(file, map);
    tbb::parallel_for_each(wanted, [&](const auto& one) { *one.second = one.first->evaluate(file); });
    if (const Image* const alpha = layers.find("alpha")) layers.isTransparent = isFilmTransparent(*alpha);
    dropEmptyDepth(layers);
    dropZeroMotion(layers);
    return layers;
}

void restoreZeroMotion(ShotLayers& layers) {
    if (layers.zeroMotion) layers.images["motion"] = Image(layers.width, layers.height, 2, 0.0f);
    layers.zeroMotion = false;
}

FrameConverter::FrameConverter(LayerMap map) : map_(std::move(map)) {}
FrameConverter::~FrameConverter() = default;

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
        tangent = horizontalTangent(*distance, *depth, map_.encoding.farDepth, layers.pixelAspect);
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
    if (map_.searchesMotion || layers.motionSearched) {  // too coarse to tell how the camera moves
        report_.camera = CameraSource::Supposed;
        return cameraWith(axes, eye, t, layers);
    }
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

void FrameConverter::addMotion(const ShotLayers& layers, const View& view, denoise::HostFrame& frame) const {
    const Image* const motion = layers.find("motion");
    if (!motion) return;
    const bool knows = !alone_ && view.comparable && last_->comparable && frame.camera.orthographic == 0;
    forEachPixel(view.distance.size(), [&](size_t p) {
        const float distance = view.distance[p];
        const auto moved = motionAt(*motion, p, map_.encoding);
        if (!moved || !(distance > 0.0f)) return;
        float before = distance;
        if (knows) {  // as if the point stood still
            const vec2 at = onScreen(p, layers);
            const vec3 ray = rayOf(frame.camera, at);
            const vec3 point = startOf(frame.camera, at) + ray * (distance / glm::length(ray));
            before = glm::length(point - last_->camera.origin);
        } else if (!alone_) {
            before = distanceAt(last_->distance, layers, vec2(p % layers.width, p / layers.width) + *moved);
        }
        const float texel[] = {moved->x, moved->y, before - distance, 1.0f};
        std::copy_n(texel, 4, &frame.motion[4 * p]);
    });
}

denoise::HostFrame FrameConverter::convertAlone(const ShotLayers& layers,
                                                const std::optional<CameraParams>& given, bool continues) {
    alone_ = true;
    reflects_ = continues;
    denoise::HostFrame frame = convert(layers, given, false);
    alone_ = false;
    return frame;
}

void FrameConverter::replaceZeroMotion(ShotLayers& layers, bool continues) {
    if (!layers.zeroMotion) return search_.reset();
    if (!search_) search_ = std::make_unique<MotionSearch>();
    search_->replaceZero(layers, map_.encoding, continues);
}

/// Frames in which hardly anything is uncovered belong to the same film: if they were treated as opaque, a
/// shot near the limit would flicker, and averages over frames would begin anew.
void FrameConverter::continueFilm(ShotLayers& layers, bool continues) {
    const bool stays = continues && wasTransparent_ && !layers.showsSky;
    layers.isTransparent = layers.isTransparent || stays;
    wasTransparent_ = layers.isTransparent;
}

denoise::HostFrame FrameConverter::convertUsingUp(ShotLayers& layers,
                                                  const std::optional<CameraParams>& given, bool continues,
                                                  bool alone) {
    replaceZeroMotion(layers, continues);
    continueFilm(layers, continues);
    used_ = &layers;
    denoise::HostFrame frame =
        alone ? convertAlone(layers, given, continues) : convert(layers, given, continues);
    used_ = nullptr;
    if (!layers.groups.empty()) limitUnfiltered(frame, layers);
    std::erase_if(layers.images,
                  [](const auto& layer) { return layer.first != "beauty" && layer.first != "alpha"; });
    return frame;
}

denoise::HostFrame FrameConverter::convert(const ShotLayers& layers, const std::optional<CameraParams>& given,
                                           bool continues) {
    continues_ = continues && last_ && last_->distance.size() == size_t{layers.width} * layers.height;
    denoise::HostFrame frame;
    frame.width = layers.width;
    frame.height = layers.height;
    frame.samples = layers.samples > 0 ? layers.samples : supposedSamples;
    frame.camera = cameraOf(layers, given);
    const bool two = layers.find("diffuse") && layers.find("specular");
    makeLight(frame, two);
    View view{frame.camera, distancesOf(layers, map_.encoding, frame.camera),
              report_.camera != CameraSource::Supposed};
    if (!layers.find("emission")) hideEmitters(layers, view.distance);
    report_.lightShare = addLight(layers, view.distance, frame);
    addMirroredEmission(layers, map_.encoding, view.distance, frame);
    limitEmission(frame);
    report_.notFinite = countNotFinite(layers.images.at("beauty"));
    report_.motionSearched = layers.motionSearched;
    report_.problems = layers.problems;
    addAlbedo(layers, frame);
    divideByAlpha(layers, view.distance, frame);
    if (used_) freeRoles(*used_, {"diffuse", "specular", "emission", "background", "mirroredEmission"});
    makeGeometry(frame);
    addGeometry(layers, map_, view.distance, frame);
    if (const Image* const roughness = layers.find("roughness"); roughness && two) {
        frame.roughness.resize(4 * frame.pixelCount());
        forEachPixel(frame.pixelCount(), [&](size_t p) { frame.roughness[4 * p] = roughness->pixels[p]; });
    }
    const bool comparable =
        last_ && view.comparable && last_->comparable && last_->distance.size() == view.distance.size();
    if (comparable && (alone_ ? reflects_ : continues_)) addReflectionMotion(layers, last_->camera, frame);
    if (used_) freeRoles(*used_, {"albedo", "albedoSpecular", "albedoReflected"});
    addSeen(layers, map_, frame);
    frame.previousNormal = frame.normal;  // files do not tell how surfaces turn
    if (continues_ || alone_) addMotion(layers, view, frame);
    if (!alone_ && last_) dropMovingMirrors(last_->camera, frame);
    report_.horizontalFov = frame.camera.orthographic != 0
                                ? 0.0f
                                : glm::degrees(2.0f * std::atan(glm::length(frame.camera.right)));
    last_ = std::move(view);
    return frame;
}

}  // namespace limpid::shot
