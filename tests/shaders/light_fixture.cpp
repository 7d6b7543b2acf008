#include "tests/shaders/light_fixture.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"

#include "embedded/light_texel.h"

#include <cmath>

namespace stromboli::test {

LightFixture::LightFixture(const ShadingConventions& conventions)
    : conventions_(conventions),
      shader_(light_texel, ShaderOptions::texel().set(SPEC_DEPARTURES, departures(conventions))) {}

void LightFixture::setScene(const Scene& scene) {
    Estimator estimator;
    estimator.conventions = conventions_;
    packed_ = packScene(scene, buildWideBvh(scene), lightSelection(estimator));
    shader_.setScene(packed_);
}

std::vector<gpu::LightAnswer> LightFixture::answers(const std::vector<gpu::LightQuery>& queries) {
    return ask<gpu::LightAnswer>(shader_, queries);
}

gpu::LightQuery LightFixture::surfaceAt(const glm::vec3& position, const glm::vec3& normal) {
    gpu::LightQuery q{};
    q.position = position;
    q.error = glm::abs(position) * (10 * 0x1p-24f);
    q.geometric = q.shading = q.wo = glm::normalize(normal);
    q.outside = 1;
    return q;
}

std::vector<gpu::LightQuery> LightFixture::samples(const gpu::LightQuery& surface, size_t n,
                                                   uint32_t seed) {
    Random random(seed);
    std::vector<gpu::LightQuery> queries(n, surface);
    for (gpu::LightQuery& q : queries)
        q.u = random.uniform(), q.v = random.uniform();
    return queries;
}

std::vector<gpu::LightQuery> LightFixture::ends(const gpu::LightQuery& surface) {
    std::vector<gpu::LightQuery> queries;
    for (const float u : {0.0f, 0x1p-24f, 0.5f, 1 - 0x1p-24f})
        for (const float v : {0.0f, 0.25f, 0.5f, 1 - 0x1p-24f}) {
            queries.push_back(surface);
            queries.back().u = u, queries.back().v = v;
        }
    return queries;
}

Scene sceneWithEmitter(const glm::vec3& emission, bool bothSides) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[1].emission = emission;
    scene.materials[1].emitsBothSides = bothSides;
    return scene;
}

void addEmitterTriangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const auto first = uint32_t(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {a, b, c});
    Triangle t;
    for (uint32_t i = 0; i < 3; ++i)
        t.corner[i] = first + i;
    t.material = 1;
    scene.triangles.push_back(t);
}

::testing::AssertionResult isSound(const gpu::LightAnswer& a) {
    const glm::vec3 all = a.target + a.direction + a.radiance;
    if (!std::isfinite(all.x + all.y + all.z)) return ::testing::AssertionFailure() << "NaN";
    if (std::abs(glm::length(glm::dvec3(a.direction)) - 1) > 1e-6)
        return ::testing::AssertionFailure() << "direction of length " << glm::length(a.direction);
    if (!(a.radiance.x >= 0 && a.radiance.y >= 0 && a.radiance.z >= 0))
        return ::testing::AssertionFailure() << "negative radiance";
    return ::testing::AssertionSuccess();
}

} // namespace stromboli::test
