// A small triangle at the origin whose shading normal is tilted towards +x, off its geometric
// normal +y.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr double kF = 0.5 / 3.14159265358979323846; ///< BSDF of the triangle
const Camera kFromAbove = pointCamera({0.5, 2, 0}, {0, 0, 0});
const glm::vec3 kShadingNormal(0.8f, 0.6f, 0);

SceneMaker tiltedTriangle(const Material& material) {
    SceneMaker b;
    b.triangle({-0.1f, 0, -0.1f}, {0, 0, 0.2f}, {0.2f, 0, -0.1f}, b.add(material));
    b.scene.normals = {kShadingNormal};
    for (uint32_t& n : b.scene.triangles[0].normals)
        n = 0;
    return b;
}

TEST(ShadingNormals, CosineIsTheirs) {
    SceneMaker b = tiltedTriangle(diffuse(0.5f));
    b.add(pointLight(1, {1, 1, 0}));
    const double cosine =
        glm::dot(glm::normalize(glm::dvec3(1, 1, 0)), glm::normalize(glm::dvec3(kShadingNormal)));
    const Estimate found = estimate(b.scene, kFromAbove, smallPicture(1, 1));
    EXPECT_NEAR(found.mean.x / (kF * cosine), 1, 1e-7);
}

TEST(ShadingNormals, NothingComesFromBelowThem) {
    SceneMaker b = tiltedTriangle(diffuse(0.5f));
    b.add(pointLight(1, {-3, 1, 0})); // above the triangle
    expectMean(estimate(b.scene, kFromAbove, smallPicture(1, 1)), 0);
}

TEST(ShadingNormals, AreFlippedForTheOtherSide) {
    SceneMaker b = tiltedTriangle(diffuse(0.5f));
    b.add(pointLight(1, {0, -1, 0}));
    const Camera fromBelow = pointCamera({-0.5, -2, 0}, {0, 0, 0});
    const Estimate found = estimate(b.scene, fromBelow, smallPicture(1, 1));
    EXPECT_NEAR(found.mean.x / (kF * 0.6), 1, 1e-7);
}

TEST(ShadingNormals, GeometricNormalStandsInBeyondTheirHorizon) {
    SceneMaker b = tiltedTriangle(diffuse(0.5f));
    b.add(pointLight(1, {0, 1, 0}));
    const Camera low = pointCamera({-2, 0.5, 0}, {0, 0, 0}); // above the triangle, below the normal
    const Estimate found = estimate(b.scene, low, smallPicture(1, 1));
    EXPECT_NEAR(found.mean.x / kF, 1, 1e-7);
}

/// An emitter below the triangle's plane, though above the shading normal's horizon: no light leaks
/// to the other side, whatever finds the emitter.
TEST(ShadingNormals, LetNoLightThroughTheSurface) {
    Material metal;
    metal.kind = MaterialKind::Conductor;
    metal.facets = {FacetDistribution::Beckmann, glm::vec2(0.8f)}, metal.k = glm::vec3(5);
    Material mirror;
    mirror.kind = MaterialKind::Mirror;
    for (const Material& material : {diffuse(0.5f), metal, mirror}) {
        SceneMaker b = tiltedTriangle(material);
        b.sphere({2, -0.4f, 0}, 0.35f, b.add(emissive(1)));
        b.add(pointLight(1, {2, -0.2f, 0}));
        for (DirectLight mode : kDirectLightModes) {
            RenderSettings s = smallPicture(64, 3);
            s.estimator.directLight = mode;
            expectMean(estimate(b.scene, kFromAbove, s), 0);
        }
    }
}

} // namespace
} // namespace stromboli
