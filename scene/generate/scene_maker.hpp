#pragma once

#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace stromboli::scenes {

/// Makes scenes in code.
class SceneMaker {
  public:
    Scene scene;

    uint32_t add(const Material& material);
    uint32_t add(const Medium& medium);
    void add(const Light& light) { scene.lights.push_back(light); }
    /// What follows belongs to a new instance (quads, boxes and spheres start their own).
    void startInstance();
    /// Counter-clockwise from the side the normal points to.
    void triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, uint32_t material);
    /// Normal edgeA x edgeB; an instance, and so an emitter, of its own.
    void quad(const glm::vec3& corner, const glm::vec3& edgeA, const glm::vec3& edgeB,
              uint32_t material);
    /// Closed box, normals outwards or inwards; one instance.
    void box(const glm::vec3& lo, const glm::vec3& hi, uint32_t material, bool inwards = false);
    void sphere(const glm::vec3& center, float radius, uint32_t material);

  private:
    /// Four corners, counter-clockwise from the side the normal points to.
    void addFace(const std::array<glm::vec3, 4>& corners, uint32_t material);
};

Material diffuse(float albedo, float emission = 0);
Material mirror(float reflectance, float emission = 0);
Material glass(float ior);
/// A rough conductor that reflects between one half and nearly all, by angle.
Material metal(float alpha, float emission = 0);
Material emissive(float radiance, bool bothSides = true);

/// Coefficients per metre.
Medium mediumOf(const glm::vec3& absorption, const glm::vec3& scattering = glm::vec3(0),
                float asymmetry = 0);
/// Nothing but the border of two media: `inside` where the normals do not point to.
Material border(uint32_t inside, uint32_t outside = kNoMedium);

/// Constant radiance from everywhere, found by rays that leave the scene.
Light ambient(float radiance);

/// A unit box with an emitter below its ceiling, a mirror and a glass sphere, and a conductor. All
/// coordinates are multiples of 1/512, so that it can be moved by whole numbers up to 2^14 exactly.
Scene cornellBox();

} // namespace stromboli::scenes
