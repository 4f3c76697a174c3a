// What scenes drawn from a number have in common: random numbers, colours, textures, materials.
#pragma once

#include <cstdint>
#include <string>

#include "scene/builtin/builtin_parts.h"

namespace limpid::scene {

/// Random numbers are drawn one a statement or within braces: elsewhere compilers choose the order.
class RandomScene {
  public:
    RandomScene(std::string_view kind, uint32_t seed);

  protected:
    bool chance(float share) { return random_.next(0.0f, 1.0f) < share; }
    int whole(int least, int most);
    /// As many small ratios as large ones.
    float logarithmic(float least, float most);
    vec3 color(float least, float most);
    /// Daylight to candle light; now and then any colour.
    vec3 lightColor();
    /// Somewhere around the origin, at most `reach` from it in each direction.
    vec3 offset(float reach);

    int addMaterial(Material material);
    /// Checkers, noise, bricks or wood.
    Texture pattern();
    Material roughened(Material material, float least);
    /// Papered with a pattern, of `least` to `most` repeats a metre.
    Material patterned(Material material, float least, float most);
    /// Diffuse, glossy, metallic, mirroring, lacquered, or a closed body of glass.
    Material anyMaterial(bool mayBeGlass);

    Scene scene_;
    Sequence random_;
};

}  // namespace limpid::scene
