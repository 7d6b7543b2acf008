#pragma once

#include "host/kernel/light_tree.hpp"
#include "host/kernel/rows.hpp"
#include "scene/model/light.hpp"

#include <vector>

namespace stromboli {

/// A light of the scene as the kernel reads it (shaders/shared/light_types.h).
struct PackedLight {
    uint32_t kindAndFlags = gpu::LIGHT_POINT; ///< LightHeader::kind
    std::vector<Row> parameters;              ///< behind its header
    LightBounds bounds;

    uint32_t kind() const { return kindAndFlags & gpu::LIGHT_KIND_MASK; }
};

/// sceneRadius: how far apart, more or less, lights and surfaces are; it decides whether a point
/// light falls off with the squared distance or hardly at all. picture: first row of its picture's
/// gpu::TextureUse; 0: it has none. The bounds of an area light, which is geometry, are empty.
PackedLight packLight(const Light& light, double sceneRadius, uint32_t picture = 0);

/// A parallelogram from its corner, with the normal a x b.
gpu::QuadLight quadLight(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b);

} // namespace stromboli
