// Which channels of a file are which layers of a frame, and how the file encodes them.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "shot/camera/camera_track.h"
#include "shot/layers/expression.h"

namespace limpid::shot {

enum class NormalSpace {
    World,   ///< that of the camera's position
    Camera,  ///< x points right, y up, z towards the viewer
};

enum class DepthKind {
    Distance,  ///< from the eye to the point, along the ray
    Planar,    ///< along the camera's axis
};

enum class MotionUnit {
    Pixels,
    Picture,  ///< 1 is the picture's width or height
};

/// How the values of normal, depth and motion are meant. The defaults are Limpid's (docs/layers.md).
struct Encoding {
    UpAxis worldUp = UpAxis::Y;  ///< of the world of normals and positions, for cameras of glTF files
    NormalSpace normalSpace = NormalSpace::World;
    vec3 normalScale{1.0f, 1.0f, 1.0f};
    vec3 cameraNormalScale{1.0f, 1.0f, 1.0f};  ///< what makes of `cameraNormal` NormalSpace::Camera
    DepthKind depthKind = DepthKind::Distance;
    float farDepth = 9e9f;  ///< from here on, nothing was hit
    MotionUnit motionUnit = MotionUnit::Pixels;
    /// What makes of the file's motion the previous position minus this one; x points right, y down.
    vec2 motionScale{1.0f, 1.0f};
    float noMotion = 9e9f;  ///< components from here on are no motion
};

/// What a role's values are; not each format of pictures holds all of them.
enum class RoleValues {
    Colors,
    Amounts,  ///< from 0 on, not of light
    Exact,    ///< with signs, or whole numbers
};

/// What `limpid denoise` reads. Only beauty is needed. The roles without `without` help:
///   - `alpha` is the coverage of transparent film, by which colours were multiplied.
///   - `background` is light that belongs to the beauty unless the film is transparent, which the sum tells.
///   - Where depth is missing (the one sample that it is from saw the background), `distance` divided by
///     `alpha` replaces it. `distance` is along the ray, from the near plane, and goes on behind mirrors and
///     smooth glass. So do `cameraNormal` (with Encoding::cameraNormalScale) and `seenAlbedo`: there they
///     replace `normal` and `albedoSpecular`.
///   - `albedoReflected` is the share of `albedoSpecular` that is not refracted: it tells mirrors.
///   - `mirroredEmission` is what smooth mirrors show of lamps and sky: light that they reflect directly.
///   - `position` (in the world), `distance` and `cameraNormal` tell the camera (camera_solve.h).
struct RoleInfo {
    std::string_view name;     ///< as in --map
    std::string_view without;  ///< what is lost if the file has no such layer; empty if little is
    uint32_t components;
    bool isImportant;  ///< worth a warning
    RoleValues values = RoleValues::Colors;
};
std::span<const RoleInfo> roles();
/// Returns null if there is no such role.
const RoleInfo* findRole(std::string_view name);

/// One picture of a file: a view layer, or an eye of a stereo pair.
struct LayerMap {
    std::string title;     ///< of the picture, empty if the file has one
    std::string view;      ///< "left", for stereo; empty without views. Texts of layers are without it
    std::string prefix;    ///< what precedes its layers' names
    std::string renderer;  ///< whose conventions were recognised
    std::map<std::string, LayerExpression, std::less<>> layers;  ///< by role
    Encoding encoding;
    bool hasIndependentPixels = false;  ///< Convention::hasIndependentPixels
    bool searchesMotion = false;        ///< the file has none: it is searched on albedo and normals
    /// The layer that the clean beauty replaces; none: that of the role "beauty".
    std::optional<LayerExpression> replaced;
    std::vector<std::string> remarks;  ///< on how the file was understood, for the user
    /// Light groups: colours by group of lamps, whose sum is (nearly) the beauty.
    std::vector<LayerExpression> groups;

    const LayerExpression* find(std::string_view role) const {
        const auto found = layers.find(role);
        return found == layers.end() ? nullptr : &found->second;
    }
    /// The layer that the clean beauty replaces.
    const LayerExpression& target() const { return replaced ? *replaced : layers.at("beauty"); }
    /// Whether it reads a channel of this part.
    bool uses(size_t part) const;
};

/// Says what it costs that the picture lacks a role.
std::string_view withoutRole(const LayerMap& map, const RoleInfo& role);

/// Assignments of --map and --map-file: a role and an expression, or one of
///
///     normal.space = world | camera         normal.scale = X,Y,Z
///     depth.kind = distance | planar        depth.far = DEPTH
///     motion.unit = pixels | picture        motion.scale = X,Y
///     world.up = y | z
///
/// An empty expression removes the role.
using Assignments = std::vector<std::pair<std::string, std::string>>;

/// Parses "KEY=VALUE". Throws UsageError.
std::pair<std::string, std::string> parseAssignment(std::string_view text);
/// Reads a JSON object of such keys and values (numbers and lists of numbers, too). Throws InputError.
Assignments readAssignments(const std::filesystem::path& file);
/// Changes the map. Throws UsageError if a key or a value is unknown, and InputError(file) if a channel is
/// missing.
void apply(const Assignments& assignments, const ChannelTable& table, const std::filesystem::path& file,
           LayerMap& map);

}  // namespace limpid::shot
