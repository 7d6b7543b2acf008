#include "tests/shaders/bsdf_fixture.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"

#include "embedded/bsdf_texel.h"

#include <utility>

namespace stromboli::test {
BsdfFixture::BsdfFixture(std::vector<Material> materials, const ShadingConventions& conventions)
    : materials_(std::move(materials)), conventions_(conventions),
      shader_(bsdf_texel, ShaderOptions::texel().set(SPEC_DEPARTURES, departures(conventions))) {
    Scene scene;
    scene.materials = materials_;
    shader_.setScene(packScene(scene, buildWideBvh(scene)));
    firstRow_ = packMaterials(materials_).firstRow;
}

std::vector<gpu::BsdfAnswer> BsdfFixture::answers(std::vector<gpu::BsdfQuery> queries) {
    for (gpu::BsdfQuery& q : queries)
        q.materialRow = firstRow_[q.material];
    return ask<gpu::BsdfAnswer>(shader_, queries);
}

gpu::BsdfQuery BsdfFixture::randomQuery(uint32_t material, Random& random) const {
    gpu::BsdfQuery q{};
    q.material = material;
    q.geometric = glm::normalize(random.vector());
    q.shading = glm::normalize(q.geometric + 0.5f * glm::normalize(random.vector()));
    q.wo = glm::normalize(random.vector());
    q.wi = glm::normalize(random.vector());
    q.outside = glm::dot(q.geometric, q.wo) >= 0;
    q.u = random.uniform(), q.v = random.uniform(), q.w = random.uniform();
    return q;
}

glm::vec3 BsdfFixture::reflected(const gpu::BsdfQuery& q, float tangent, Random& random) {
    const glm::vec3 n = glm::dot(q.wo, q.shading) < 0 ? -q.shading : q.shading;
    const glm::vec3 side = glm::normalize(glm::cross(n, random.vector()));
    const glm::vec3 h = glm::normalize(n + tangent * side);
    return glm::normalize(2 * glm::dot(q.wo, h) * h - q.wo);
}

reference::SurfacePoint BsdfFixture::surface(const gpu::BsdfQuery& q) const {
    reference::SurfacePoint s;
    s.geometric = q.geometric;
    s.shading = q.shading;
    s.wo = q.wo;
    s.outside = q.outside != 0;
    s.material = &materials_[q.material];
    reference::faceForward(s, conventions_);
    return s;
}

} // namespace stromboli::test
