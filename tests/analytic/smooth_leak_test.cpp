// No light passes an opaque surface, whatever its normals say: exactly none.
#include "tests/analytic/smooth_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <random>

namespace stromboli {
namespace {

using namespace test;

Material mirror() {
    Material m;
    m.kind = MaterialKind::Mirror;
    return m;
}

Material leakingMetal() {
    Material m;
    m.kind = MaterialKind::Conductor;
    m.facets = {FacetDistribution::Beckmann, glm::vec2(0.8f)}, m.k = glm::vec3(5);
    return m;
}

/// Every pixel exactly black, no sample rejected, in each way of finding light.
void expectDark(const Scene& scene, const Camera& camera) {
    for (const DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(64, 4);
        s.estimator.directLight = mode;
        for (const PixelStatistics& p : renderFilm(scene, camera, s).pixels) {
            ASSERT_EQ(p.rejected, 0u);
            ASSERT_EQ(p.mean, glm::dvec3(0.0));
        }
    }
}

Camera fromOutside() {
    Camera camera;
    camera.orthographic = true;
    camera.position = {0, 0, 5};
    camera.halfWidth = camera.halfHeight = 1;
    return camera;
}

TEST(SmoothLeak, NoneOutOfAClosedSphere) {
    SceneMaker b;
    addSmoothSphere(b, 5, 8, b.add(diffuse(0.5f)));
    const uint32_t materials[] = {0, b.add(mirror()), b.add(leakingMetal())};
    for (size_t i = 0; i < b.scene.triangles.size(); ++i)
        b.scene.triangles[i].material = materials[i % 3];
    b.sphere({0.3f, 0.2f, 0}, 0.4f, b.add(emissive(5)));
    b.add(pointLight(10, {0, -0.3f, 0.4f}));
    expectDark(b.scene, fromOutside());
}

TEST(SmoothLeak, NoneIntoAClosedSphere) {
    SceneMaker b;
    addSmoothSphere(b, 5, 8, b.add(diffuse(0.5f)));
    b.sphere({1.6f, 0.2f, 0}, 0.4f, b.add(emissive(5)));
    b.add(pointLight(10, {0, -1.3f, 0.4f}));
    expectDark(b.scene, pointCamera({0.1, 0, 0}, {0.5, 0.3, 0.2}, 1.0));
}

/// The walls of a room [-1, 1]^3, each of 4 x 4 squares whose corners have normals of their own,
/// tilted by up to `mostTilt` radians: no smooth surface at all.
Scene roughRoom(double mostTilt) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform;
    SceneMaker b;
    const uint32_t material = b.add(diffuse(0.5f));
    b.startInstance();
    const auto tilted = [&](const glm::dvec3& n, const glm::dvec3& x, const glm::dvec3& y) {
        const double angle = mostTilt * uniform(generator), turn = 6.28 * uniform(generator);
        return glm::vec3(std::cos(angle) * n +
                         std::sin(angle) * (std::cos(turn) * x + std::sin(turn) * y));
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            glm::dvec3 n(0.0), x(0.0), y(0.0);
            n[axis] = -side, x[(axis + 1) % 3] = 1, y[(axis + 2) % 3] = -side;
            const auto at = [&](int i, int j) {
                return glm::vec3(-n + (0.5 * i - 1) * x + (0.5 * j - 1) * y);
            };
            std::vector<glm::vec3> normals;
            for (int k = 0; k < 25; ++k)
                normals.push_back(tilted(n, x, y));
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j) {
                    const auto add = [&](int i1, int j1, int i2, int j2) {
                        b.triangle(at(i, j), at(i1, j1), at(i2, j2), material);
                        setNormals(b.scene, b.scene.triangles.size() - 1, normals[5 * i + j],
                                   normals[5 * i1 + j1], normals[5 * i2 + j2]);
                    };
                    add(i + 1, j, i + 1, j + 1);
                    add(i + 1, j + 1, i, j + 1);
                }
        }
    return b.scene;
}

TEST(SmoothLeak, NoneIntoARoomWithWildNormals) {
    for (const double tilt : {0.3, 1.4}) {
        SceneMaker b;
        b.scene = roughRoom(tilt);
        b.sphere({0, -1.6f, 0}, 0.5f, b.add(emissive(5)));
        b.sphere({0, 0.2f, 2.6f}, 1.4f, b.add(emissive(5)));
        b.add(pointLight(10, {1.2f, 1.1f, 0.9f}));
        expectDark(b.scene, pointCamera({0.1, 0, 0}, {-0.5, -0.3, -0.2}, 2.0));
    }
}

/// Corner normals in the plane, on its other side, or cancelling each other: the triangle is taken
/// as flat, nothing leaks, and every sample is a number.
TEST(SmoothLeak, DegenerateNormals) {
    const glm::vec3 up(0, 1, 0), down(0, -1, 0), level(1, 0, 0);
    const glm::vec3 cases[][3] = {{up, level, up},
                                  {level, -level, up},
                                  {up, down, up},
                                  {up, down, level},
                                  {glm::vec3(0, 1e-20f, 1), up, glm::vec3(0.5f, -1e-20f, 1)}};
    SceneMaker b;
    const uint32_t grey = b.add(diffuse(0.5f));
    for (size_t i = 0; i < std::size(cases); ++i) {
        const float x = 0.5f * float(i) - 1;
        b.triangle({x - 0.2f, 0, -0.2f}, {x, 0, 0.4f}, {x + 0.2f, 0, -0.2f}, grey);
        setNormals(b.scene, i, cases[i][0], cases[i][1], cases[i][2]);
    }
    b.sphere({1, -0.6f, 0}, 0.5f, b.add(emissive(5)));
    b.sphere({-1, -0.6f, 0}, 0.5f, b.add(emissive(5)));
    b.add(pointLight(10, {0.1f, -0.2f, 0}));
    Camera above = pointCamera({0, 2, 0}, {0, 0, 0}, 0.6);
    above.farDistance = 2.01; // sees the triangles, but not the emitters
    expectDark(b.scene, above);
    b.add(pointLight(10, {0, 1, 0.2f}));
    for (const PixelStatistics& p : renderFilm(b.scene, above, smallPicture(16, 2)).pixels)
        EXPECT_EQ(p.rejected, 0u);
}

} // namespace
} // namespace stromboli
