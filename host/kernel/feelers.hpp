#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "scene/camera/camera.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

/// A ray that feels how a place lies: from a surface into the half space that the surface is seen
/// from. Where it starts need not be exact, and opacity is not looked at: what is decided by such
/// rays changes how long a picture takes, not what it shows.
struct Feeler {
    glm::vec3 origin, direction; ///< unit
    bool isFree = true;          ///< it has met nothing
    glm::vec3 met{0};            ///< else a point just before where it ended,
    glm::vec3 normal{0};         ///< and of what: unit, towards the origin; 0: a sphere
    uint32_t visited = 0;        ///< records of the tree,
    uint32_t spheres = 0;        ///< and of these, spheres
};
using Feelers = std::vector<Feeler>;

/// Whether a primitive, by its place in the tree, is what feelers go straight through; empty: none
/// is.
using SeesThrough = std::function<bool(uint32_t place)>;

/// Rays through a grid of side x side points of the picture, without those that meet nothing.
Feelers lookAround(const WideLayout& bvh, const Camera& camera, uint32_t side,
                   const SeesThrough& seesThrough = {});

/// `each` rays, one after the other, from where each of these has ended.
Feelers feelFrom(const WideLayout& bvh, std::span<const Feeler> ended, size_t each, Random& random,
                 const SeesThrough& seesThrough = {});

/// What a ray of a path visits on its way, on average: records of the tree, and of these, spheres.
struct VisitsOfRay {
    double records = 0, spheres = 0;

    bool isKnown() const { return records > 0; }
    bool operator==(const VisitsOfRay&) const = default;
};

/// From the camera and after one and two bounces. Unknown: the camera sees nothing.
VisitsOfRay visitsOfRay(const WideLayout& bvh, const Camera& camera);

/// The share of those that meet nothing; empty: there are none.
std::optional<double> shareOfFree(std::span<const Feeler> feelers);

} // namespace stromboli
