#pragma once

#include "scene/pbrt/context.hpp"
#include "scene/pbrt/parameters.hpp"

#include <optional>
#include <vector>

namespace stromboli::pbrt {

/// A surface of a lens of several elements, or its aperture stop. All lengths are metres.
struct LensSurface {
    double curvatureRadius = 0; ///< its centre is behind it where this is positive; 0: the stop
    double toNext = 0;          ///< along the axis, to the next surface towards the film
    double index = 1;           ///< of refraction, of what lies behind the surface
    double apertureRadius = 0;
};

/// The thin lens that shows what a lens of several elements does near its axis.
struct ThinLens {
    double perFilmLength = 0; ///< the tangent in front of the lens for a metre on the film, 1 / m
    double radius = 0;        ///< of the entrance pupil, metres
    double focusDistance = 0; ///< from the entrance pupil, metres
    double beforeFilm = 0;    ///< how far in front of the film the entrance pupil lies, metres
    double focalLength = 0;   ///< metres
    double irradiance = 0;    ///< in the middle of the film, for a radiance of 1
};

/// The surfaces of a lens file in the order in which light meets them; the stop is as wide as
/// `apertureDiameter` (metres), at most as the file says. Throws SceneError at the parameter if
/// these are no surfaces.
std::vector<LensSurface> surfacesOf(const Context& context, const Parameters& camera,
                                    double apertureDiameter);

/// A lens of one element of that focal length, with the stop before it; metres.
std::vector<LensSurface> simpleLens(double focalLength, double apertureDiameter);

/// Focused at `focus` metres in front of the film; at infinity where nothing so near can be sharp.
/// Nothing if the surfaces are no lens that makes a picture.
std::optional<ThinLens> thinLensOf(const std::vector<LensSurface>& surfaces, double focus);

} // namespace stromboli::pbrt
