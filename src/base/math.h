// Vector types with the same names in C++ (here) and in GLSL. Uses glm's types if available. The standalone
// denoising library is built without glm and only stores vectors.
#pragma once

#include <cstdint>

#ifdef LIMPID_HAVE_GLM
#include <glm/glm.hpp>
#endif

namespace limpid {

using uint = std::uint32_t;

#ifdef LIMPID_HAVE_GLM
using glm::ivec2;
using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
#else
struct vec2 {
    float x, y;
};
struct vec3 {
    float x, y, z;
};
struct vec4 {
    float x, y, z, w;
};
struct uvec2 {
    uint x, y;
};
#endif

inline constexpr float pi = 3.14159265358979323846f;

}  // namespace limpid
