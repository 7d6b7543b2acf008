#pragma once

#include "scene/model/medium_grid.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

struct Scene;

/// No medium of the scene: light goes straight on.
inline constexpr uint32_t kNoMedium = 0xFFFFFFFFu;

/// Which way particles send the light that they scatter. cos: between the directions in which light
/// goes before and after; densities per steradian.
enum class PhaseFunction : uint32_t {
    HenyeyGreenstein, ///< (1 - g^2) / (4 pi (1 + g^2 - 2 g cos)^1.5); isotropic for g = 0
    Rayleigh,         ///< 3 / (16 pi) (1 + cos^2)
};

/// One of the phase functions whose sum is a medium's.
struct PhaseLobe {
    PhaseFunction phase = PhaseFunction::HenyeyGreenstein;
    float asymmetry = 0; ///< Henyey-Greenstein: the mean cosine g, within kMostAsymmetry of 0
    float share = 0;     ///< of the light that is scattered, at most 1

    bool operator==(const PhaseLobe&) const = default;
};

/// Light that a black body of a temperature sends out, in a table.
struct GlowTable {
    float coldest = 0, hottest = 0; ///< kelvins: what is colder sends out nothing
    /// At equal steps of the temperature's inverse, from coldest to hottest: red, green and blue
    /// over the luminance, and its logarithm. At least two.
    std::vector<glm::vec4> values;

    glm::dvec3 at(double kelvins) const;
};

/// How colours of a medium differ from place to place, where they do. Only where its density or its
/// extinction does.
struct MediumColors {
    /// Factors of the extinction by channel, in place of Medium::density.
    std::optional<ColorGrid> extinction;
    /// The share of the extinction that is scattering, at most 1; outside of its cube the outermost
    /// values go on. In place of what the medium's coefficients say.
    std::optional<ColorGrid> scattering;
    /// They are no shares, but factors of the medium's extinction() that give the scattering, which
    /// is nowhere more than the extinction.
    bool scatteringIsFactor = false;
    /// Radiance, which times the absorption is what the medium sends out per metre; in place of
    /// Medium::emission. With `glow` the temperature in kelvins is in the second channel, and a
    /// factor of what it glows with in the first one.
    std::optional<ColorGrid> source;
    std::optional<GlowTable> glow;
};

/// What a medium does at a place, per metre.
struct MediumPoint {
    glm::dvec3 extinction{0.0}, scattering{0.0}, emission{0.0};
};

/// What fills a part of space, absorbs light, scatters it and may shine.
struct Medium {
    std::string name;
    glm::vec3 absorption{0.0f}; ///< per metre, times the density; finite, not negative
    glm::vec3 scattering{0.0f}; ///< likewise
    glm::vec3 emission{0.0f};   ///< radiance that comes in per metre, times the density
    PhaseFunction phase = PhaseFunction::HenyeyGreenstein;
    float asymmetry = 0; ///< Henyey-Greenstein: the mean cosine g, within kMostAsymmetry of 0
    /// Beside that function, which has what their shares leave of 1: at most kMostPhases - 1.
    std::vector<PhaseLobe> otherPhases;
    /// It lies under a surface that scatters light as its formats say that a surface does: what
    /// happens in it, and on its boundary from inside, does not count as a bounce, and light
    /// samples, in whose way the surface would be, are not taken in it.
    bool isUnderSurface = false;
    std::optional<DensityGrid> density; ///< none: the same everywhere, but for `colors`
    MediumColors colors;

    glm::vec3 extinction() const { return absorption + scattering; }
    bool varies() const { return density || colors.extinction; }
    bool scatters() const;
    bool emits() const;
    /// Of one that varies: at a place of the world, and of the cube of its density or extinction,
    /// within which it counts.
    MediumPoint at(const glm::dvec3& world, const glm::dvec3& place) const;
    /// Of one that varies: numbers of which, times the largest channel of extinction(), none is
    /// less than the extinction.
    DensityGrid bound() const;
    /// Every grid's rows, for a world that moves.
    std::vector<std::array<glm::dvec4, 3>*> places();
    /// The whole sum, the shares of which are 1 together.
    std::vector<PhaseLobe> phases() const;
    /// Takes these in place of what there is: the shares in proportion, equal functions as one. Of
    /// more than kMostPhases those with the largest shares are taken. Returns whether all are.
    bool setPhases(std::vector<PhaseLobe> lobes);
};

/// Beyond, floats cannot tell the peak of Henyey and Greenstein's function from a single direction.
inline constexpr float kMostAsymmetry = 0.9999f;
/// How many phase functions a medium may be a sum of.
inline constexpr size_t kMostPhases = 3;

/// Leaves out all media where no surface and no camera is in contact with one. Where a scene has
/// media, gives every surface that light passes into a volume the media on both
/// sides that are not stated: inside, one that absorbs as the material says, or none; outside,
/// that of Scene::surrounding, or other volumes (orderVolumes()). A scene without media is left as
/// it is.
void resolveMedia(Scene& scene);

/// The medium that a place is in, or kNoMedium: that of the volume that counts (orderVolumes()), or
/// by the first border, of those that a ray from there towards the middle of all borders meets, and
/// Scene::surrounding where it meets none. Surfaces that are no borders do not count. Takes time in
/// proportion to the triangles.
uint32_t mediumAt(const Scene& scene, const glm::dvec3& place);

} // namespace stromboli
