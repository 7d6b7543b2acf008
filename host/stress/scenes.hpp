#pragma once

#include "host/stress/run.hpp"
#include "scene/camera/camera.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/model/scene.hpp"

namespace stromboli::stress {

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

} // namespace stromboli::stress
