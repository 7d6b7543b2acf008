#include "scene/pbrt/lenses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace stromboli::pbrt {
namespace {

/// A ray near the axis, in a plane through it. Heights and slopes behind the lens are linear in
/// those in front of it.
struct AxialRay {
    double height = 0, slope = 0;

    void refract(const LensSurface& surface, double indexBefore) {
        if (surface.curvatureRadius == 0) return;
        const double power = (surface.index - indexBefore) / surface.curvatureRadius;
        slope = (indexBefore * slope - height * power) / surface.index;
    }
    void advance(double distance) { height += distance * slope; }
};

/// pbrt writes 0 for the index of air; the stop has what is around it.
double indexBehind(const LensSurface& surface, double before) {
    if (surface.curvatureRadius == 0) return before;
    return surface.index > 0 ? surface.index : 1;
}

/// The distance from the last surface to the film at which what is `focus` in front of the film is
/// sharp. level and oblique: behind the lens, of length `length`, the rays that were (1, 0) and
/// (0, 1) in front of it.
double filmDistance(const AxialRay& level, const AxialRay& oblique, double length, double focus) {
    const double atInfinity = -level.height / level.slope;
    // A ray from the axis at s = focus - length - v in front of the lens comes back to the axis
    // where (s level + oblique) has the height 0 on the film: a quadratic equation of v.
    const double room = focus - length;
    const double a = level.slope, b = level.height - oblique.slope - room * level.slope,
                 c = -(room * level.height + oblique.height);
    const double discriminant = b * b - 4 * a * c;
    if (!(discriminant >= 0)) return atInfinity;
    const double root = std::sqrt(discriminant);
    const double one = (-b + root) / (2 * a), other = (-b - root) / (2 * a);
    const double near = std::abs(one - atInfinity) < std::abs(other - atInfinity) ? one : other;
    return std::isfinite(near) && near > 0 ? near : atInfinity;
}

} // namespace

std::vector<LensSurface> surfacesOf(const Context& context, const Parameters& camera,
                                    double apertureDiameter) {
    const Parameter* file = camera.find("lensfile");
    const std::string name = camera.text("lensfile").value_or("");
    const build::FilePlace where = file ? camera.placeOf(*file) : camera.place();
    const std::vector<double> n = context.files.numbers(where, name, "surfaces of a lens");
    if (n.empty() || n.size() % 4 != 0)
        where.fail(fmt::format("names a file of {} numbers, expected four for each surface of the "
                               "lens",
                               n.size()));
    constexpr double kMillimetre = 1e-3;
    std::vector<LensSurface> surfaces;
    for (size_t i = 0; i < n.size(); i += 4) {
        LensSurface s{n[i] * kMillimetre, n[i + 1] * kMillimetre, n[i + 2],
                      n[i + 3] / 2 * kMillimetre};
        if (s.curvatureRadius == 0)
            s.apertureRadius = std::min(s.apertureRadius, apertureDiameter / 2);
        surfaces.push_back(s);
    }
    return surfaces;
}

std::vector<LensSurface> simpleLens(double focalLength, double apertureDiameter) {
    // Half of the power is that of each side of a sheet of no thickness.
    return {{0, 0, 1, apertureDiameter / 2}, {focalLength, 0, 1.5, 0}, {-focalLength, 0, 1, 0}};
}

std::optional<ThinLens> thinLensOf(const std::vector<LensSurface>& surfaces, double focus) {
    AxialRay level{1, 0}, oblique{0, 1};
    double length = 0, index = 1;
    double narrowest = std::numeric_limits<double>::infinity();
    AxialRay levelAtStop = level, obliqueAtStop = oblique; // a lens without a stop is its own
    for (size_t i = 0; i < surfaces.size(); ++i) {
        LensSurface s = surfaces[i];
        s.index = indexBehind(s, index);
        // How wide a beam from far away may be for this surface.
        if (s.apertureRadius > 0 && level.height != 0)
            narrowest = std::min(narrowest, std::abs(s.apertureRadius / level.height));
        if (s.curvatureRadius == 0) {
            levelAtStop = level;
            obliqueAtStop = oblique;
        }
        for (AxialRay* ray : {&level, &oblique})
            ray->refract(s, index);
        index = s.index;
        if (i + 1 == surfaces.size()) break;
        for (AxialRay* ray : {&level, &oblique})
            ray->advance(s.toNext);
        length += s.toNext;
    }
    if (!(level.slope < 0) || levelAtStop.height == 0) return std::nullopt;
    ThinLens lens;
    lens.focalLength = -1 / level.slope;
    const double v = filmDistance(level, oblique, length, focus);
    if (!(v > 0)) return std::nullopt;
    // The entrance pupil is where rays in front of the lens aim that meet the stop's middle: so far
    // behind the first surface.
    const double toPupil = obliqueAtStop.height / levelAtStop.height;
    lens.beforeFilm = length + v - toPupil;
    lens.radius = std::isfinite(narrowest) ? narrowest : 0;
    lens.focusDistance = focus - lens.beforeFilm;
    const double chief = -toPupil * (level.height + v * level.slope) + oblique.height +
                         v * oblique.slope; // on the film, of a slope of 1 in front
    if (chief == 0) return std::nullopt;
    lens.perFilmLength = 1 / std::abs(chief);
    // The cone of light that meets the middle of the film comes from the point that is sharp there.
    const double ahead = lens.focusDistance;
    const double slope = ahead > 0 ? lens.radius / ahead : 0;
    const double height = slope * (ahead - toPupil);
    const double behind =
        ahead > 0 ? height * level.slope + slope * oblique.slope : lens.radius * level.slope;
    lens.irradiance = std::numbers::pi * behind * behind;
    return lens;
}

} // namespace stromboli::pbrt
