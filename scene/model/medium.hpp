#pragma once

#include <glm/glm.hpp>

#include <array>
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

/// How dense a medium is from place to place: a factor of its coefficients.
struct DensityGrid {
    glm::uvec3 size{0}; ///< values along x, y and z, at least 1
    /// x changes fastest. Values are at the middles of cells that fill the unit cube; between them
    /// they are interpolated linearly, and up to the cube's faces the outermost ones go on. Outside
    /// of the cube there is nothing. Finite, not negative.
    std::vector<float> values;
    /// Rows of the matrix from the world to the unit cube.
    std::array<glm::dvec4, 3> toUnit{glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0),
                                     glm::dvec4(0, 0, 1, 0)};

    /// At a place of the unit cube, or outside of it.
    double at(const glm::dvec3& place) const;
    glm::dvec3 place(const glm::dvec3& world) const;
    /// matrix: from the unit cube to the world.
    void setWorld(const glm::dmat4& matrix);
    float largest() const;
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
    std::optional<DensityGrid> density; ///< none: the same everywhere

    glm::vec3 extinction() const { return absorption + scattering; }
    bool scatters() const { return scattering.x > 0 || scattering.y > 0 || scattering.z > 0; }
    /// The whole sum, the shares of which are 1 together.
    std::vector<PhaseLobe> phases() const;
    /// Takes these in place of what there is: the shares in proportion, equal functions as one. Of
    /// more than kMostPhases those with the largest shares are taken. Returns whether all are.
    bool setPhases(std::vector<PhaseLobe> lobes);
    bool emits() const { return emission.x > 0 || emission.y > 0 || emission.z > 0; }
};

/// Beyond, floats cannot tell the peak of Henyey and Greenstein's function from a single direction.
inline constexpr float kMostAsymmetry = 0.9999f;
/// How many phase functions a medium may be a sum of.
inline constexpr size_t kMostPhases = 3;

/// Leaves out all media where no surface and no camera is in contact with one. Where a scene has
/// media, gives every surface that light passes into a volume the media on both
/// sides that are not stated: inside, one that absorbs as the material says, or none; outside,
/// that of Scene::surrounding. A scene without media is left as it is.
void resolveMedia(Scene& scene);

/// The medium that a place is in, or kNoMedium: by the first border, of those that a ray from there
/// towards the middle of all borders meets, and Scene::surrounding where it meets none. Surfaces
/// that are no borders do not count. Takes time in proportion to the triangles.
uint32_t mediumAt(const Scene& scene, const glm::dvec3& place);

} // namespace stromboli
