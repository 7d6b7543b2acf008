#pragma once

#include <glm/glm.hpp>

namespace stromboli::reference {

/// A film so thin that light reflected at its two sides interferes, on a surface in air: Belcour
/// and Barla 2017 with the approximations of KHR_materials_iridescence for three channels.
struct ThinFilm {
    double index;     ///< of refraction, > 0
    double thickness; ///< nanometres, >= 0

    /// Reflectance of film and surface, each channel in [0, 1]. cosine: in air, in (0, 1]; f0: what
    /// the surface reflects at normal incidence without the film, in [0, 1].
    glm::dvec3 reflectance(double cosine, const glm::dvec3& f0) const;
};

} // namespace stromboli::reference
