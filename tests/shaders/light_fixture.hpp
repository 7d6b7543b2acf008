#pragma once

#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include <vector>

namespace stromboli::test {

/// Asks light.comp for samples of the lights of a scene, packed as the renderer packs them.
class LightFixture : public DeviceTest {
  protected:
    explicit LightFixture(const ShadingConventions& conventions = {});

    void setScene(const Scene& scene);
    std::vector<gpu::LightAnswer> answers(const std::vector<gpu::LightQuery>& queries);

    /// A surface at `position` that faces `normal`, seen from there.
    static gpu::LightQuery surfaceAt(const glm::vec3& position, const glm::vec3& normal);
    /// That surface with n samples of light 0.
    static std::vector<gpu::LightQuery> samples(const gpu::LightQuery& surface, size_t n,
                                                uint32_t seed);
    /// Samples for every pair of u and v from the ends of their interval.
    static std::vector<gpu::LightQuery> ends(const gpu::LightQuery& surface);

    GpuScene packed_;

  private:
    ShadingConventions conventions_;
    TestShader shader_;
};

/// A scene with material 0 that reflects and material 1 that emits.
Scene sceneWithEmitter(const glm::vec3& emission, bool bothSides);
void addEmitterTriangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Checks that an answer has no NaN and no negative radiance.
::testing::AssertionResult isSound(const gpu::LightAnswer& a);

} // namespace stromboli::test
