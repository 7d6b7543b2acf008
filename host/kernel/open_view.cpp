#include "host/kernel/open_view.hpp"

#include "host/bvh/cpu_traversal.hpp"

#include <algorithm>

namespace stromboli {
namespace {

/// Along each side of the picture. The share of 1024 rays is within 0.05 of the picture's in 99.9
/// of 100 cases even if they fell at random, and they take a millisecond.
constexpr int kRaysAlongSide = 32;

/// x, y: in [-1, 1], to the right and up.
TraversalRay centralRay(const Camera& camera, double x, double y) {
    const glm::dvec3 offset = (x * camera.halfWidth + camera.shift.x) * camera.right +
                              (y * camera.halfHeight + camera.shift.y) * camera.up;
    TraversalRay ray;
    ray.origin = camera.orthographic ? camera.position + offset : camera.position;
    const glm::dvec3 direction = camera.orthographic ? -camera.back : offset - camera.back;
    ray.direction = direction; // of length 1 along the view axis
    const double lengthPerUnit = camera.clipAlongRay ? 1 / glm::length(direction) : 1;
    ray.tMin = float(camera.nearDistance * lengthPerUnit);
    ray.tMax = float(std::min(camera.farDistance * lengthPerUnit, double(kInfiniteDistance)));
    return ray;
}

} // namespace

double shareOfSurfacesInView(const WideLayout& bvh, const Camera& camera) {
    int hits = 0;
    for (int j = 0; j < kRaysAlongSide; ++j)
        for (int i = 0; i < kRaysAlongSide; ++i) {
            const double x = (2 * i + 1.0) / kRaysAlongSide - 1,
                         y = (2 * j + 1.0) / kRaysAlongSide - 1;
            hits += anyHit(bvh, centralRay(camera, x, y));
        }
    return double(hits) / (kRaysAlongSide * kRaysAlongSide);
}

} // namespace stromboli
