#pragma once

#include "host/bench/embree_lights.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli::bench {

/// The scene in the arrays of the path tracer on Embree. What embreePathsLack() names must not be
/// in it.
class EmbreeWorld {
  public:
    EmbreeWorld(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                const native::Tracer& tracer);
    EmbreeWorld(const EmbreeWorld&) = delete;
    EmbreeWorld& operator=(const EmbreeWorld&) = delete;

    const native::World& world() const { return world_; }
    /// What paths in it must be able to do: kHas... bits.
    uint32_t features() const { return features_; }

  private:
    void addSurfaces(const Scene& scene);
    void addGeometry(const Scene& scene);
    void addLights(const Scene& scene, const RenderSettings& settings);
    void setView(const Camera& camera);
    void setSettings(const RenderSettings& settings);

    std::vector<native::Surface> surfaces_;
    std::vector<native::TriangleShading> triangles_;
    std::vector<glm::vec4> normals_;
    std::vector<native::Sphere> spheres_;
    EmbreeLights lights_;
    native::World world_{};
    uint32_t features_ = 0;
};

} // namespace stromboli::bench
