#pragma once

#include <glm/glm.hpp>

namespace stromboli::sky {

/// The sky of Hosek and Wilkie (An analytic model for full spectral sky-dome radiance, 2012) and
/// the sun in it (Adding a solar-radiance function to the Hosek-Wilkie skylight model, 2013), in
/// Rec. 709 and in Mitsuba's unit: what is 1 there.
class SkyModel {
  public:
    /// turbidity: 1 to 10; albedo: of the ground, in [0, 1]; sunElevation: radians, 0 to pi / 2.
    SkyModel(double turbidity, const glm::dvec3& albedo, double sunElevation);

    /// Radiance of the sky without the sun. cosine: of the angle from the zenith, not negative;
    /// cosSun: of the angle from the middle of the sun.
    glm::dvec3 sky(double cosine, double cosSun) const;
    /// The mean of the sun's disk, as it is in the sky.
    glm::dvec3 sun() const;

    /// Radians: half the angle that the disk of these numbers has.
    static double halfSun();

  private:
    struct Channel {
        double shape[9];
        double radiance;
    };
    Channel channels_[3];
    glm::dvec3 sun_{0.0};
};

} // namespace stromboli::sky
