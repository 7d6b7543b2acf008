#pragma once

#include "scene/model/emitters.hpp"
#include "shaders/shared/scene_types.h"

#include <vector>

namespace stromboli {

/// A triangle that emits, as a light tree knows it.
struct LightTriangle {
    glm::dvec3 corner[3]; ///< the normal of the side that always emits: counter-clockwise
    double power = 0;     ///< powerOf()
    bool bothSides = false;
    uint32_t id = 0; ///< what an entry of the tree names it by
};

/// The triangles of quads and meshes, in their order; id: into Scene::triangles.
std::vector<LightTriangle> lightTriangles(const Scene& scene, const std::vector<Emitter>& emitters);

/// Balanced binary tree over triangles with what bounds their light: a sphere, a cone of normals
/// and the power (Conty Estevez and Kulla 2018). Leaves have an alias table by power.
struct LightTree {
    std::vector<gpu::LightNode> nodes; ///< 0: the root; siblings side by side
    std::vector<gpu::EmitterEntry> entries;
    uint32_t levels = 0; ///< from the root to the deepest leaf, steps
};

/// Splits at the median, so that all leaves are equally deep but for one level, along the axis
/// where power x area x orientation of the halves is least. At least one triangle.
LightTree buildLightTree(std::vector<LightTriangle> triangles);

/// One alias table over all of the triangles: by power, or uniformly.
std::vector<gpu::EmitterEntry> lightTable(const std::vector<LightTriangle>& triangles,
                                          bool uniformly);

} // namespace stromboli
