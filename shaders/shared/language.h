// Lets one header be read by C++ and by GLSL. C++ gets GLSL's type names from glm; constants
// become inline constexpr. Include this first in every shared header.
#ifndef STROMBOLI_SHARED_LANGUAGE_H
#define STROMBOLI_SHARED_LANGUAGE_H

#ifdef __cplusplus
#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#define SHARED_BEGIN namespace stromboli::gpu {
#define SHARED_END }
#define SHARED_CONST inline constexpr
#define SHARED_FUNCTION inline constexpr
/// A structure is a whole number of 16-byte rows, the unit in which shaders fetch it.
#define SHARED_ROWS(type, rows) static_assert(sizeof(type) == 16 * (rows), #type)
#define SHARED_WHOLE_ROWS(type) static_assert(sizeof(type) % 16 == 0, #type)
#define SHARED_OFFSET(type, member, bytes)                                                         \
    static_assert(offsetof(type, member) == (bytes), #type "::" #member)
namespace stromboli::gpu {
using uint = uint32_t;
using glm::uvec2;
using glm::vec3;
using glm::vec4;
} // namespace stromboli::gpu
#else
#define SHARED_BEGIN
#define SHARED_END
#define SHARED_CONST const
#define SHARED_FUNCTION
#define SHARED_ROWS(type, rows)
#define SHARED_WHOLE_ROWS(type)
#define SHARED_OFFSET(type, member, bytes)
#endif

#endif
