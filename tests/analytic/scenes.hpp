#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/layers.hpp"
#include "host/render/recorded_path.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/model/scene.hpp"
#include "tests/support/numbers.hpp"

#include <initializer_list>
#include <span>
#include <vector>

namespace stromboli::test {

using namespace scenes;

/// Side 20, y = 0, normal up.
void addFloor(SceneMaker& builder, uint32_t material);

/// Sees the point `at` from `from`, so narrowly that the whole picture is that point.
inline Camera pointCamera(const glm::dvec3& from, const glm::dvec3& at, double halfWidth = 1e-10) {
    return lookingAt(from, at, halfWidth);
}

/// A sphere about the origin, of radius 1, in ambient light of radiance 1.
Scene sphereInAmbientLight(const Material& material);
/// Stands before that sphere, which fills its picture.
inline const Camera kOutside = pointCamera({0, 0, 4}, {0, 0, 0}, 0.18);
/// In the middle of closed rooms and spheres.
inline const Camera kInside = pointCamera({0.1, 0.2, 0.3}, {0.7, -0.4, 0.1}, 1.0);
/// Over slabs and layers at z = 0, a little from the vertical.
inline const Camera kAbove = pointCamera({0.2, 0.1, 8}, {0.1, 0.2, 0});
/// Errors of the fitted albedos (shaders/shared/albedo_fits.h).
inline constexpr double kFits = 0.0117;

/// A point light of this radiant intensity in each channel.
Light pointLight(float intensity, const glm::vec3& position);

/// Settings of a small picture without roulette.
RenderSettings smallPicture(uint32_t samplesPerPixel, uint32_t maxBounces);

/// The mean over all pixels and samples, with its standard error.
struct Estimate {
    glm::dvec3 mean{0.0}, error{0.0};
};

/// Renders with the renderer that the executable is about: render_with_reference.cpp or
/// render_with_kernel.cpp. threads: the reference's; 0 for all.
Film renderFilm(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                unsigned threads = 0);
/// The first `count` samples of a pixel, each taken on its own.
std::vector<SampleValue> samplesAlone(const Scene& scene, const Camera& camera,
                                      const RenderSettings& settings, uint32_t pixel,
                                      uint32_t count);
/// One of them with its path.
RecordedPath recordedAlone(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           uint32_t pixel, uint32_t sample);
/// What its camera rays see: samples[i] of pixel i.
std::vector<SeenPixel> seenBy(const Scene& scene, const Camera& camera,
                              const RenderSettings& settings, const std::vector<uint32_t>& samples,
                              Seeing what);
/// What the renderer's statistics make of samples, accepted ones, in this order.
glm::dvec3 meanInOrder(std::span<const SampleValue> samples);
/// Relative error that the renderer's arithmetic may put on a mean.
extern const double kRounding;
Estimate estimate(const Scene& scene, const Camera& camera, const RenderSettings& settings);

/// Fails if the estimate is 4.5 standard errors from the expected value in a channel; false alarm
/// below 1e-5 per channel. kRounding of the value is allowed besides.
void expectMean(const Estimate& found, const glm::dvec3& expected);
void expectMean(const Estimate& found, double expected);
/// Expects likewise of two independent estimates of one value.
void expectSameMean(const Estimate& a, const Estimate& b);

/// Whether the renderer weights light samples and bounces. The reference does not: Mis, MisAll and
/// Lights are one estimator there, of which a picture each would be compared with itself.
extern const bool kCombinesLightSamplesWithBounces;
/// Whether a mode is another way to find light than those that its tests have beside it.
inline bool isAnotherWay(DirectLight mode) {
    return kCombinesLightSamplesWithBounces ||
           (mode != DirectLight::MisAll && mode != DirectLight::Lights);
}

inline constexpr DirectLight kDirectLightModes[] = {DirectLight::Mis, DirectLight::MisAll,
                                                    DirectLight::Hemisphere, DirectLight::Bsdf};

} // namespace stromboli::test
