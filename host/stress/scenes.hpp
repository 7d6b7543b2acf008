#pragma once

#include "host/film/film.hpp"
#include "host/stress/case.hpp"
#include "scene/camera/camera.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli::stress {

// --- Scenes --------------------------------------------------------------------------------------

using namespace scenes;

/// The sizes that scenes are tried at.
std::vector<float> sizes(const Run& run);

/// The scene times `factor`, then moved, rounded to float.
Scene placed(Scene scene, float factor, const glm::vec3& by = glm::vec3(0.0f));
Camera placed(Camera camera, double factor, const glm::dvec3& by = glm::dvec3(0.0));
/// Turned by a rotation without a zero in it.
Scene turned(Scene scene);

/// Settings of a square picture, no roulette.
RenderSettings picture(uint32_t side, uint32_t samplesPerPixel, uint32_t maxBounces);

inline constexpr DirectLight kDirectLightModes[] = {DirectLight::Mis, DirectLight::Hemisphere,
                                                    DirectLight::Bsdf};

// --- Totals of pictures --------------------------------------------------------------------------

/// All samples of a picture together.
struct Totals {
    explicit Totals(const Film& film);
    explicit Totals(const PixelStatistics& samples) : all(samples) {}

    /// Sum of the samples' values, of the channel that has most.
    double sum() const;
    /// Standard error of the mean.
    glm::dvec3 error() const { return glm::sqrt(all.varianceOfMean()); }

    PixelStatistics all;
};

/// All samples of a picture's column, counted from the left.
PixelStatistics columnOf(const Film& film, uint32_t x);

/// Relative error that the kernel's arithmetic may put on a mean: a sample is a product and sum of
/// some hundred float operations, each good to 2^-24 to 2^-22, over paths of up to 100 bounces.
inline constexpr double kRounding = 0x1p-14;

/// How far a mean is from what it should be, in standard errors of both, in the worst channel.
/// kRounding of the expected value is free; beyond it, a mean without error is infinitely far off.
double sigmasOff(const Totals& found, const glm::dvec3& expected);
double sigmasOff(const Totals& found, const Totals& other);

// --- Lookups as pictures -------------------------------------------------------------------------

/// A texture (into Scene::textures) asked at a point.
struct Lookup {
    uint32_t texture = 0;
    glm::vec2 uv{0.0f};
};

/// What the subject finds, in the order of the lookups: red, green, blue. One picture: each lookup
/// is the emission of a square that fills one pixel and has the same coordinates at all corners.
/// NaN where a pixel has no sample. textures: a scene with images and textures alone.
std::vector<glm::dvec3> lookUpInPicture(Run& run, const Scene& textures,
                                        const std::vector<Lookup>& lookups);

} // namespace stromboli::stress
