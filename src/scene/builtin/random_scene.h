// Shared by the scenes generated from a seed: random numbers, colours, textures, materials.
#pragma once

#include <cstdint>
#include <string>

#include "scene/builtin/builtin_parts.h"

namespace limpid::scene {

/// Draw only one random number per statement, or several within braces: elsewhere the compiler chooses the
/// order.
class RandomScene {
  public:
    RandomScene(std::string_view kind, uint32_t seed);

  protected:
    bool chance(float share) { return random_.next(0.0f, 1.0f) < share; }
    int whole(int least, int most);
    /// A log-uniform number: small and large ratios are equally likely.
    float logarithmic(float least, float most);
    vec3 color(float least, float most);
    /// A colour from daylight to candle light; occasionally any colour.
    vec3 lightColor();
    /// A random offset from the origin, at most `reach` in each direction.
    vec3 offset(float reach);

    int addMaterial(Material material);
    /// Checkers, noise, bricks or wood.
    Texture pattern();
    Material roughened(Material material, float least);
    /// Textured with a pattern that repeats `least` to `most` times per metre.
    Material patterned(Material material, float least, float most);
    /// Diffuse, glossy, metallic, mirror, lacquered, or a closed body of glass.
    Material anyMaterial(bool mayBeGlass);

    Scene scene_;
    Sequence random_;
};

}  // namespace limpid::scene
