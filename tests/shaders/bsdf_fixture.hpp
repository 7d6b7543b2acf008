#pragma once

#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/reference/bsdf.hpp"
#include "host/reference/sampling.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include <vector>

namespace stromboli::test {

/// Asks bsdf.comp about materials, packed as the renderer packs them, and holds the same surfaces
/// up to the reference.
class BsdfFixture : public DeviceTest {
  protected:
    BsdfFixture(std::vector<Material> materials, const ShadingConventions& conventions);

    std::vector<gpu::BsdfAnswer> answers(std::vector<gpu::BsdfQuery> queries);

    /// Normals as stored and directions any which way: the shading normal within 30 degrees of
    /// the geometric one, wo and wi on either side; u, v, w at random.
    gpu::BsdfQuery randomQuery(uint32_t material, Random& random) const;

    /// wo mirrored about a half vector at this tangent to the shading normal that faces wo.
    static glm::vec3 reflected(const gpu::BsdfQuery& q, float tangent, Random& random);

    /// The surface as the reference sees it, faced forward.
    reference::SurfacePoint surface(const gpu::BsdfQuery& q) const;

    std::vector<Material> materials_;
    ShadingConventions conventions_;
    std::vector<uint32_t> firstRow_; ///< by material

  private:
    TestShader shader_;
};

} // namespace stromboli::test
