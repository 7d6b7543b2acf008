#pragma once

#include "host/reference/bvh.hpp"
#include "scene/model/light_foci.hpp"
#include "scene/model/medium.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::reference {

/// The draw of distances about the lamps that are near a stretch of a ray, at equal angles as seen
/// from one of them (Kulla and Fajardo 2012; docs/theory/media.md, "Lamps that are near").
class NearLights {
  public:
    /// Draws nothing.
    NearLights() = default;
    /// medium: the same everywhere. from, to: distances on the ray, which ends at `to` on a
    /// surface, or nowhere: infinite. share: of the path's channels, 1 together.
    NearLights(const LightFoci& foci, const Medium& medium, const Ray& ray, double from, double to,
               const glm::dvec3& share);

    /// The share of distances that is drawn so: at most 1/2.
    double share() const { return share_; }
    /// A distance from the beginning of the stretch to a point of it. Both in [0, 1).
    double draw(double which, double u) const;
    /// Its density, per metre.
    double density(double distance) const;

  private:
    struct Near {
        double closest;    ///< where the ray comes closest, from the beginning of the stretch
        double apart;      ///< how close it comes, but at least about the lamp's radius
        double first, all; ///< the angle where the stretch begins, and all that it takes up
        double weight;     ///< running sum
    };
    std::vector<Near> near_;
    double share_ = 0;
};

} // namespace stromboli::reference
