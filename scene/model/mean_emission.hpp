#pragma once

#include "scene/model/surface_lookup.hpp"

#include <map>
#include <vector>

namespace stromboli {

/// What emissive primitives emit on average, for choosing lights by. With a texture it is an
/// estimate, from points of a grid, but it is 0 only where nothing is emitted at all: a light that
/// is never chosen would be lost. Refers to the scene, which must outlive it.
class MeanEmission {
  public:
    explicit MeanEmission(const Scene& scene);

    /// Radiance, times the share of the surface that is there.
    glm::dvec3 ofTriangle(uint32_t triangle) const;
    /// The emission of what has no texture coordinates: it is alike everywhere.
    glm::dvec3 ofSphere(uint32_t sphere) const;
    /// Luminance of a triangle's emission (Rec. 709) times the area of the sides that emit.
    double powerOfTriangle(uint32_t triangle) const;

  private:
    /// The largest values of a texture in blocks of kBlock x kBlock texels.
    struct Blocks {
        uint32_t columns = 0, rows = 0;
        std::vector<glm::vec3> largest;
    };
    static constexpr uint32_t kBlock = 16;

    Blocks blocksOf(const Texture& texture) const;
    glm::dvec3 largestOn(uint32_t triangle, const TextureUse& use) const;

    const Scene& scene_;
    std::map<uint32_t, Blocks> blocks_; ///< by texture
};

} // namespace stromboli
