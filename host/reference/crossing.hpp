#pragma once

#include "host/reference/bvh.hpp"
#include "host/reference/surface.hpp"
#include "scene/model/medium.hpp"

#include <vector>

namespace stromboli::reference {

/// What a path is in between two surfaces.
struct Filling {
    const Material* volume =
        nullptr;                    ///< whose inside it is, which absorbs; in scenes without media
    const Medium* medium = nullptr; ///< in scenes with media
    /// Where volumes overlap: numbers of the media of those that it is in, the one that counts
    /// first, and what is around them.
    std::vector<uint32_t> volumes;
    const Medium* around = nullptr;
};

/// In that medium, or none, and in no volume.
Filling fillingOf(const Medium* medium);

/// What is behind a surface that is passed from there, in a scene with media.
Filling behind(const Scene& scene, const SurfacePoint& surface, const Filling& here);

/// Which media a ray is in, where borders and surfaces lie in one plane, so that rounding says
/// which of them is met first (docs/theory/media.md, "Borders in the planes of surfaces").
class Crossing {
  public:
    /// For a ray that begins there.
    explicit Crossing(const Filling& start) : settled_(start) {}

    /// The ray passes a surface at the distance t, having passed another one, or begun, at `from`.
    /// Returns what it is in behind. here: what it was in before.
    Filling pass(const Scene& scene, const Ray& ray, const SurfacePoint& surface, double from,
                 double t, const Filling& here);
    /// What it is in where it meets a surface that is there.
    Filling arrive(const Ray& ray, const SurfacePoint& surface, double from, double t,
                   const Filling& here) const;

  private:
    bool isInPassedPlane(const Ray& ray, const SurfacePoint& surface, double from, double t) const;

    Filling settled_;   ///< what it was last in for longer than rounding can make up
    double error_ = -1; ///< of the plane passed last; below 0: nothing was passed
    /// The border passed last says that the ray was in another medium before than it was.
    bool isUntold_ = false;
};

/// The ray that leaves the surface on its other side. Where that is no border, it starts on the
/// side that it comes from, so that it meets a border in the surface's plane.
Ray rayThroughMedia(const Scene& scene, const SurfacePoint& surface, const glm::dvec3& direction);

} // namespace stromboli::reference
