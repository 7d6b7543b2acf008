#pragma once

#include "host/stress/run.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <array>

namespace stromboli::stress {

/// Makes scenes for the cases.
class SceneMaker {
  public:
    Scene scene;

    uint32_t add(const Material& material);
    void add(const Light& light) { scene.lights.push_back(light); }
    /// Normal edgeA x edgeB; an instance, and so a lamp, of its own.
    void quad(const glm::vec3& corner, const glm::vec3& edgeA, const glm::vec3& edgeB,
              uint32_t material);
    /// Closed box, normals outwards or inwards; one instance.
    void box(const glm::vec3& lo, const glm::vec3& hi, uint32_t material, bool inwards = false);
    void sphere(const glm::vec3& center, float radius, uint32_t material);

  private:
    void startInstance();
    /// Four corners, counter-clockwise from the side the normal points to.
    void addFace(const std::array<glm::vec3, 4>& corners, uint32_t material);
};

Material diffuse(float albedo, float emission = 0);
Material mirror(float reflectance, float emission = 0);
Material glass(float ior);
/// A rough conductor that reflects between one half and nearly all, by angle.
Material metal(float alpha, float emission = 0);
Material lamp(float radiance, bool bothSides = false);

/// Constant radiance from everywhere, found by rays that leave the scene.
Light ambient(float radiance);

/// A unit box with a lamp below its ceiling, a mirror and a glass sphere, and a conductor. All
/// coordinates are multiples of 1/512, so that it can be moved by whole numbers up to 2^14 exactly.
Scene cornellBox();

/// The sizes that scenes are tried at.
std::vector<float> sizes(const Run& run);

/// The scene times `factor`, then moved, rounded to float.
Scene placed(Scene scene, float factor, const glm::vec3& by = glm::vec3(0.0f));
Camera placed(Camera camera, double factor, const glm::dvec3& by = glm::dvec3(0.0));
/// Turned by a rotation without a zero in it.
Scene turned(Scene scene);

/// Sees `at` from `from`; halfWidth: the tangent of half the angle of view, or half the width of an
/// orthographic picture.
Camera lookingAt(const glm::dvec3& from, const glm::dvec3& at, double halfWidth);

/// Settings of a square picture, no roulette.
RenderSettings picture(uint32_t side, uint32_t samplesPerPixel, uint32_t maxBounces);

inline constexpr DirectLight kDirectLightModes[] = {DirectLight::Lights, DirectLight::Hemisphere,
                                                    DirectLight::Bsdf};
const char* nameOf(DirectLight mode);

} // namespace stromboli::stress
