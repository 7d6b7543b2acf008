#pragma once

#include <glm/glm.hpp>

namespace stromboli::reference {

/// The directions in which a triangle is seen, sampled uniformly by solid angle: Arvo, "Stratified
/// Sampling of Spherical Triangles" (SIGGRAPH 1995).
class SphericalTriangle {
  public:
    /// Below this solid angle (steradians) the sum of angles from which it comes has lost too many
    /// digits: 16 roundings of 2^-53 of angles up to pi are 2^-20 of it.
    static constexpr double kSmallest = 0x1p-27;

    /// Unit directions of the corners.
    SphericalTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

    /// Steradians, in [0, 2 pi].
    double solidAngle() const { return area_; }
    /// Unit; u, v: independent, uniform in [0, 1). Density 1 / solidAngle(), which is at least
    /// kSmallest.
    glm::dvec3 sample(double u, double v) const;

  private:
    glm::dvec3 a_, b_, c_;
    double alpha_, area_; ///< alpha_: the angle at a
};

} // namespace stromboli::reference
