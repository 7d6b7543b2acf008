#pragma once

#include <glm/glm.hpp>

namespace stromboli::reference {

/// A smooth interface between two dielectrics, seen from the side of the incident ray.
struct Interface {
    double reflectance = 1;    ///< unpolarised; 1 in total reflection
    double cosTransmitted = 0; ///< of the refracted ray to the normal, >= 0
    bool total = true;         ///< total reflection: there is no refracted ray
};

/// cosine: of incidence, in [0, 1]; eta: index of the incident side over that of the other.
Interface dielectric(double cosine, double eta);

/// Unpolarised reflectance of a conductor of index eta + i k against vacuum, per colour channel.
/// cosine: of incidence, in (0, 1].
glm::dvec3 conductor(double cosine, const glm::dvec3& eta, const glm::dvec3& k);

/// An approximation of conductor() for k^2 >> 1.
glm::dvec3 approximateConductor(double cosine, const glm::dvec3& eta, const glm::dvec3& k);

/// Schlick's approximation of a dielectric of index `ior` against vacuum.
double schlick(double cosine, double ior);

} // namespace stromboli::reference
