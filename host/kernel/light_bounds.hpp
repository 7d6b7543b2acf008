#pragma once

#include "scene/model/emitters.hpp"
#include "scene/model/mean_emission.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/light_types.h"

#include <cstdint>

namespace stromboli {

/// What bounds the light that a light sends out, as a light tree knows it. In double: squares of
/// areas leave the range of float.
struct LightBounds {
    uint32_t group = gpu::LIGHT_GROUP_NEAR;
    glm::dvec3 lo{0.0}, hi{0.0}; ///< box of where it is; infinite lights: of no meaning
    double reach = 0;            ///< a sphere about the box is widened by this
    glm::dvec3 axis{0, 0, 1}; ///< unit: of a cone that holds its normals, or directions of travel
    double cosSpread = -1;    ///< of the cone's half angle
    bool bothSides = false;   ///< emits against its normals too
    bool sharp = false;       ///< sends nothing out of the cone
    /// Luminance (Rec. 709) of the irradiance it brings at most to a surface that faces it; near
    /// lights: times the squared distance.
    double power = 0;
};

LightBounds boundsOfTriangle(const Scene& scene, uint32_t triangle, const MeanEmission& means);
/// A quad or a sphere.
LightBounds boundsOfEmitter(const Scene& scene, const Emitter& emitter, const MeanEmission& means);
/// Not an area light. sceneRadius: how far apart, more or less, lights and surfaces are; it decides
/// whether a point light falls off with the squared distance or hardly at all.
LightBounds boundsOfLight(const Light& light, double sceneRadius);
/// luminance: integral over all directions.
LightBounds boundsOfEnvironment(double luminance);

} // namespace stromboli
