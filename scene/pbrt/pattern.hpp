#pragma once

#include "scene/model/texture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace stromboli::pbrt {

/// From places on surfaces to the coordinates (s, t) of a texture.
struct Mapping {
    enum class Kind { Uv, Planar, Spherical, Cylindrical };
    Kind kind = Kind::Uv;
    glm::dvec2 scale{1.0}, offset{0.0};        ///< Uv: of the surface's coordinates
    glm::dvec3 sAxis{1, 0, 0}, tAxis{0, 1, 0}; ///< Planar
    glm::dmat4 textureFromWorld{1.0};          ///< of any kind but Uv
    bool isOfUnitSphere = false; ///< Cylindrical: the height is that on the sphere of radius 1

    bool operator==(const Mapping&) const = default;
    /// (s, t) of a place in the world, of any kind but Uv.
    glm::dvec2 at(const glm::dvec3& world) const;
};

/// A texture: a function of (s, t) that a picture can hold, or a colour.
struct Pattern {
    bool isConstant = true;
    glm::dvec3 color{1.0}; ///< of constants; of pictures in a file, a factor

    Mapping mapping;
    std::function<glm::dvec3(const glm::dvec2&)> at;
    glm::dvec2 period{1.0}; ///< so much of s and t is in the picture, which is repeated
    glm::uvec2 texels{1};   ///< of this part
    bool isNearest = false; ///< it is alike within a texel
    Wrap wrap = Wrap::Repeat;

    /// The picture of a file that it is, times `color`; nothing where that is no picture or is to
    /// be made anew. Its texture is in the scene.
    std::optional<uint32_t> texture;

    uint32_t number = 0; ///< of the texture in the file that it is; 0: it is none

    static Pattern constant(const glm::dvec3& color);
    glm::dvec3 valueAt(const glm::dvec2& st) const { return isConstant ? color : at(st); }
    glm::dvec3 mean() const;
};

using PatternPointer = std::shared_ptr<const Pattern>;
using Combine = std::function<glm::dvec3(const glm::dvec3&, const glm::dvec3&, const glm::dvec3&)>;

/// A pattern of three others. Where they have different mappings, the picture holds one unit of the
/// surface's coordinates; false: one of them is of another kind of mapping, and counts by its mean.
bool combine(const Pattern& a, const Pattern& b, const Pattern& c, const Combine& how,
             Pattern& result);

/// Gradient noise by the permutation of K. Perlin, "Improving Noise", 2002, in [-1, 1].
double noise(const glm::dvec3& p);

} // namespace stromboli::pbrt
