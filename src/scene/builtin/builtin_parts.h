// Building blocks of the built-in scenes: plain materials and shapes, placement, movement, and fixed random
// numbers.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/builtin/mesh_builder.h"
#include "scene/model/scene.h"

namespace limpid::scene {

Material lambertian(std::string name, const vec3& albedo);
Material emitter(std::string name, const vec3& albedo, const vec3& radiance);
Material glossy(std::string name, const vec3& color, float metallic, float roughness);
/// Returns the material with its base colour multiplied by this texture.
Material textured(Material material, const TextureRef& baseColor);

/// Adds a block on the floor, turned about its centre (x, z).
void addBlock(MeshBuilder& builder, const vec2& center, const vec2& halfSize, float height, float angle,
              uint16_t slot);
/// Adds a rectangle that faces down.
void addLamp(MeshBuilder& builder, const vec3& center, float halfWidth, float halfDepth, uint16_t slot);

/// Adds the texture; the returned reference repeats it `repeats` times per unit of texture coordinates.
TextureRef addTexture(Scene& scene, Texture texture, float repeats = 1.0f);
/// Adds a camera with the name of the scene.
void addCamera(Scene& scene, const vec3& eye, const vec3& target, float verticalFov);
/// Adds the mesh and an instance of it, and returns the instance's index. `material` is for slot 0.
size_t addMesh(Scene& scene, Mesh mesh, int material);

/// Gives the instance a node of its own, for channels to move, and returns it.
int addNode(Scene& scene, size_t instance);
/// Adds the clip and places all instances at its start.
void addClip(Scene& scene, Clip clip);

/// A small pseudo-random generator with a fixed sequence, so that built-in scenes are the same everywhere.
class Sequence {
  public:
    explicit Sequence(uint32_t seed = 1) : state_(seed) {}

    float next(float low, float high) {
        state_ = state_ * 747796405u + 2891336453u;
        const uint32_t word = ((state_ >> ((state_ >> 28) + 4u)) ^ state_) * 277803737u;
        return low + (high - low) * static_cast<float>(((word >> 22) ^ word) >> 8) * 0x1p-24f;
    }

  private:
    uint32_t state_;
};

}  // namespace limpid::scene
