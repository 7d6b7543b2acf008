#pragma once

#include "scene/model/environment.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::reference {

/// The environment's radiance, and samples of it: a row and a texel in it by running sums of
/// weights, then any direction in the texel's patch of the sphere. A texel's weight is its solid
/// angle times the largest luminance among it and its neighbours, which no interpolated value in
/// it exceeds.
class EnvironmentMap {
  public:
    explicit EnvironmentMap(const Environment& environment);

    /// From a unit direction.
    glm::dvec3 radiance(const glm::dvec3& direction) const;

    struct Sample {
        glm::dvec3 direction{0, 0, 1}; ///< unit
        glm::dvec3 weight{0.0};        ///< radiance over density by solid angle
    };
    /// u: each uniform in [0, 1).
    Sample sample(const glm::dvec3& u) const;

  private:
    glm::dvec3 texel(int64_t x, int64_t y) const;
    double neighbourhoodLuminance(int64_t x, int64_t y) const;

    Environment environment_;
    std::vector<double> rowSums_, sumsInRow_;
};

} // namespace stromboli::reference
