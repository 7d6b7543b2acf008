#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <string_view>

namespace stromboli::build {

/// What a medium under a surface does, per unit of length; by channel.
struct Scattering {
    glm::dvec3 scattered{0.0}, absorbed{0.0};

    glm::dvec3 extinction() const { return scattered + absorbed; }
    glm::dvec3 albedo() const; ///< 0 where nothing is extinguished
};

/// A medium that was measured, as skin1, in letters of any size: reduced scattering and absorption
/// per millimetre. H. W. Jensen, S. R. Marschner, M. Levoy and P. Hanrahan, "A Practical Model for
/// Subsurface Light Transport", 2001, figure 5.
std::optional<Scattering> measuredMedium(std::string_view name);

/// The share of diffuse light that a medium without an end behind a plane sends back, where the
/// plane neither reflects nor refracts. albedo: of one scattering, in [0, 1]; g: the mean cosine.
/// H. C. van de Hulst, Multiple Light Scattering, 1980: within 0.003.
double reflectanceOfDepth(double albedo, double g);
/// The albedo for such a share, in [0, 1]: the inverse.
double albedoOfDepth(double reflectance, double g);

/// The albedo of a single scattering under an interface of that index, for which the interface
/// lets out `reflectance` of the diffuse light that has come in; in [0, 1].
double albedoUnderInterface(double reflectance, double g, double ior);

/// A medium by what a surface over it shows and by the mean free path in it, which is more than 0.
Scattering scatteringUnder(const glm::dvec3& reflectance, const glm::dvec3& meanFreePath, double g,
                           double ior);

} // namespace stromboli::build
