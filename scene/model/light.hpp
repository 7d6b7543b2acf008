#pragma once

#include "scene/model/texture.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>

namespace stromboli {

enum class LightKind : uint32_t {
    Directional, ///< delta: irradiance `color` on a surface facing it
    Point,       ///< delta: irradiance color / attenuation(d) on a surface facing it at distance d
    Spot,        ///< delta: Point times a cone falloff
    Ambient,     ///< constant radiance `color` from infinity; not seen by camera rays
    Projector,   ///< delta: intensity `color`, times a picture and an edge
    Area,        ///< rectangle of radiance `color`, on the side its normal points to
};

/// A light that is not the emission of a material. All in world space.
struct Light {
    std::string name;
    LightKind kind = LightKind::Point;
    glm::vec3 color{1.0f};
    glm::vec3 position{0.0f};      ///< Point, Spot, Projector; Area: centre of the rectangle
    glm::vec3 direction{0, 0, -1}; ///< unit, the way the light travels: Directional, Spot; Area:
                                   ///< the normal of the emitting side
    /// Point, Spot: attenuation(d) = constant + linear d + quadratic d^2, d in world units.
    float constantAttenuation = 1, linearAttenuation = 0, quadraticAttenuation = 0;
    /// Spot: full opening angle of the cone, radians; inside, irradiance is multiplied by
    /// cos(angle to the axis)^falloffExponent; outside it is 0.
    float falloffAngle = 3.14159265f;
    float falloffExponent = 0;
    /// Spot with a soft edge: full opening angle of the cone in which the light is undiminished,
    /// less than falloffAngle. From there outwards irradiance is multiplied by
    /// ((cos(angle to the axis) - cosOuter) / (cosInner - cosOuter))^2, with the cosines of half
    /// the two angles; falloffExponent has no meaning.
    std::optional<float> innerAngle;
    bool upperHemisphereOnly = false;   ///< Ambient: only from directions with world y > 0 (CGL)
    glm::vec3 edgeX{0.0f}, edgeY{0.0f}; ///< Area: full edge vectors; area = |edgeX x edgeY|

    /// Projector: a direction d of the light has the texture coordinates 0.5 + (edgeX . d, edgeY .
    /// d) / (direction . d) of the picture, if there is one; edges are across the direction. Half
    /// of falloffAngle is where it ends, half of innerAngle where it begins to, linearly in the
    /// angle.
    std::optional<TextureUse> picture;
    /// Projector: what has no coordinates in [0, 1] is dark, and `color` is that along the
    /// direction: it grows with the cube of the secant, so that a plane across is lit evenly.
    bool isFramed = false;

    /// Shines from a place, without a surface.
    bool isLamp() const {
        return kind == LightKind::Point || kind == LightKind::Spot || kind == LightKind::Projector;
    }
    /// No ray meets it.
    bool isDelta() const { return isLamp() || kind == LightKind::Directional; }
};

/// Members that came after the first checkpoints (material.hpp).
inline auto laterMembers(const Light& l) {
    [[maybe_unused]] const auto& [name, kind, color, position, direction, constant, linear,
                                  quadratic, angle, exponent, innerAngle, upperOnly, edgeX, edgeY,
                                  picture, isFramed] = l;
    return std::tie();
}

} // namespace stromboli
