#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/ray_types.h"

#include <algorithm>
#include <string>
#include <vector>

namespace stromboli::bench {

/// Rays of one kind, all contestants' alike.
struct RaySet {
    std::string name;
    bool anyHit = false; ///< shadow rays: is anything in the way?
    std::vector<gpu::TracedRay> rays;
};

struct RaySets {
    RaySet camera{"camera", false, {}};
    RaySet shadow{"shadow", true, {}};
    RaySet bounce{"bounce", false, {}}; ///< cosine-distributed

    uint64_t largest() const {
        return std::max({camera.rays.size(), shadow.rays.size(), bounce.rays.size()});
    }
};

/// Rays as paths make them, once, in double precision on the CPU and rounded to float: jittered
/// camera rays; from where they hit, one shadow ray each to a point of an emitter taken at random
/// (those that could bring light; they end 2^-12 of their length before the emitter) and one bounce
/// ray. They start off the surface by the error bound of docs/numerics.md, on the side they go to.
/// In tiles of 8 x 8 pixels, in the order in which the kernel takes pixels. A pure function of its
/// arguments. perPixel: camera rays a pixel.
RaySets makeRaySets(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                    uint32_t perPixel);

/// The same of a scene with placements, of which the reference has no tree, by the tree of the
/// device; bounces go by geometric normals, and shadow rays to anywhere in the sky.
RaySets makePlacedRaySets(const Scene& scene, const WideLayout& layout, const Camera& camera,
                          const RenderSettings& settings, uint32_t perPixel);

} // namespace stromboli::bench
