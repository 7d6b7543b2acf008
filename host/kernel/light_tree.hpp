#pragma once

#include "scene/model/emitters.hpp"
#include "scene/model/mean_emission.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/light_types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

// --- Bounds of lights ----------------------------------------------------------------------------

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
/// luminance: integral over all directions.
LightBounds boundsOfEnvironment(double luminance);

// --- The tree ------------------------------------------------------------------------------------

/// Binary trees over lights with what bounds their light: a sphere, a cone of normals and the power
/// (Conty Estevez and Kulla 2018). One tree for each group; a leaf is one light. All levels are
/// full but the deepest, so that nodes need no links (gpu::LightNode).
struct LightTree {
    std::vector<gpu::LightNode> nodes; ///< 2 * lights of each group, group by group
    std::vector<uint32_t> order;       ///< by the light's number: its index in what was given
    std::vector<uint32_t> trails;      ///< by the light's number: LightEntry::trail
    std::array<uint32_t, gpu::LIGHT_GROUP_COUNT> lightsInGroup{};
    uint32_t levels = 0; ///< steps from a root to the deepest leaf
    uint32_t groups = 0; ///< bit n: group n has lights
};

/// The powers of nodes whose lights each have `factors` times their own power, by number. nodes: of
/// buildLightTree(), whose lights these are in its order.
void setPowers(std::span<gpu::LightNode> nodes, std::span<const uint32_t> lightsInGroup,
               std::span<const LightBounds> lights, std::span<const double> factors);

/// Numbers the lights anew. Splits where the layout asks for it, at the median or near it, along
/// the axis where power x area x orientation of the parts is least.
LightTree buildLightTree(std::span<const LightBounds> lights);

} // namespace stromboli
