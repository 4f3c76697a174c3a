// The vector types of both sides: these names mean the same in C++ (here) and in GLSL.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace limpid {

using glm::ivec3;
using glm::mat3;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = std::uint32_t;
using uvec2 = glm::uvec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
using ivec2 = glm::ivec2;

inline constexpr float pi = 3.14159265358979323846f;

}  // namespace limpid
