// Hard cases 11, 12 and 16: triangles that have no area, are not finite or are there many times.
#include "host/core/error.hpp"
#include "tests/hard_cases/hits.hpp"
#include "tests/hard_cases/naive_intersection.hpp"
#include "tests/scene/collada/document_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::test {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Triangles without area are never hit; the loader drops them and says how many.
TEST_F(HardCases, C11_TrianglesWithoutArea) {
    Random random(1111);
    Scene scene;
    scene.materials.resize(1);
    std::vector<stress::Ray> rays;
    uint32_t taken = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::vec3 a = random.inCube(1), b = random.inCube(1);
        const glm::vec3 corners[] = {a, a, b, b, a, a}; // two or three of them are the same
        const glm::vec3* c = corners + random.below(4);
        const glm::vec3 origin = random.inCube(2);
        const glm::vec3 target = a + random.uniform() * (b - a);
        addTriangle(scene, c[0], c[1], c[2]);
        rays.push_back({origin, naive::kMissed, target - origin, 0});
        // Without the cut-off, which loses small triangles, all that is left is NaN.
        taken += naive::hitTriangle(c[0], c[1], c[2], origin, target - origin, 0) != naive::kMissed;
    }
    const HitCounts hits = countHits(scene, rays);
    EXPECT_EQ(hits.cpu, 0u);
    EXPECT_EQ(hits.device, 0u);
    EXPECT_GT(taken, 0u) << "negative control: a determinant of zero";

    DocumentText document;
    document.libraries = meshLibrary(
        "0 0 0 1 0 0 0 1 0 2 0 0", 12,
        fmt::format("<triangles count=\"4\">{}<p>0 1 2 0 1 1 0 0 0 0 1 3</p></triangles>",
                    kVertexInput));
    document.nodes = meshNode();
    const Scene loaded = load(document);
    EXPECT_EQ(loaded.triangles.size(), 1u);
    EXPECT_THAT(loaded.report.warnings,
                testing::Contains(testing::HasSubstr("3 of 4 triangles left out: 3 of zero area")));
}

/// A mesh file with a corner at `far` among good ones.
Scene loadWithCorner(const std::string& far) {
    DocumentText document;
    document.libraries = meshLibrary(
        "0 0 0 1 0 0 0 1 0 " + far + " 0 0", 12,
        fmt::format("<triangles count=\"2\">{}<p>0 1 2 0 3 2</p></triangles>", kVertexInput));
    document.nodes = meshNode();
    return load(document);
}

/// A corner beyond all measure costs its triangle, no other; NaN in a file is an error; what is
/// infinite in memory is refused before a box could be spoilt.
TEST_F(HardCases, C12_CornersThatAreNotFiniteAmongGoodOnes) {
    for (const char* far : {"1e38", "-1e38", "1e300"}) {
        const Scene scene = loadWithCorner(far);
        ASSERT_EQ(scene.triangles.size(), 1u) << far;
        EXPECT_THAT(scene.report.warnings,
                    testing::Contains(testing::HasSubstr("1 of 2 triangles left out")));
        const HitCounts hits =
            countHits(scene, {{{0.25f, 0.25f, 1}, naive::kMissed, {0, 0, -1}, 0}});
        EXPECT_EQ(hits.cpu, 1u);
        EXPECT_EQ(hits.device, 1u);
    }
    EXPECT_THROW(loadWithCorner("NaN"), SceneError);
    EXPECT_THROW(loadWithCorner("INF"), SceneError);

    for (const float bad : {kInfinity, -kInfinity}) {
        Scene scene = sceneOf({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        addTriangle(scene, {0, 0, 0}, {bad, 0, 0}, {0, 1, 0});
        EXPECT_THROW(buildWideBvh(scene), SceneError) << bad;
    }
    // Negative control: the box of all corners as it is often written.
    glm::vec3 lo(kInfinity), hi(-kInfinity);
    for (const glm::vec3& p : {glm::vec3(0, 0, 0), glm::vec3(1, 1, 0), glm::vec3(kNaN, 0, 0)})
        for (int k = 0; k < 3; ++k)
            lo[k] = p[k] > lo[k] ? lo[k] : p[k], hi[k] = p[k] < hi[k] ? hi[k] : p[k];
    EXPECT_FALSE(naive::entersBox(lo, hi, {0.25f, 0.25f, 1}, {0, 0, -1}, naive::kMissed))
        << "negative control: NaN in a box hides the good triangles";
}

/// One quad 64 times, each of another colour: every sample has one of the colours, and the
/// picture is the same to the last bit for any way to cut the work. Which copy is seen depends on
/// the tree, and on nothing else.
TEST_F(HardCases, C16_CoplanarCopies) {
    Scene scene;
    for (uint32_t i = 0; i < 64; ++i) {
        addTriangle(scene, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0});
        addTriangle(scene, {-1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
        Material m;
        m.emission = glm::vec3(float(i + 1));
        scene.materials.push_back(m);
        for (uint32_t k = 0; k < 2; ++k)
            scene.triangles[2 * i + k].material = i;
    }
    scene.instances = {"quads"};
    Camera camera;
    camera.position = {0, 0, 1};
    camera.halfWidth = camera.halfHeight = 0.5;
    RenderSettings s;
    s.area.width = s.area.height = 16, s.budget.mostSamplesPerPixel = 1, s.estimator.maxBounces = 0;
    stress::DeviceSubject device(testDevice());
    const Film first = device.render(scene, camera, s, {}, {}).film;
    const Film again = device.render(scene, camera, s, {.workgroupSize = 16, .lanes = 64}, {}).film;
    uint32_t depends = 0;
    for (size_t i = 0; i < first.pixels.size(); ++i) {
        const double colour = first.pixels[i].mean.x;
        EXPECT_EQ(colour, std::round(colour));
        EXPECT_TRUE(colour >= 1 && colour <= 64) << colour;
        EXPECT_EQ(again.pixels[i].mean.x, colour);
    }
    // Negative control: the last copy tested wins, whatever the order of the tests.
    for (uint32_t start = 0; start < 64; ++start) {
        float t = naive::kMissed;
        uint32_t winner = 0;
        for (uint32_t k = 0; k < 64; ++k)
            if (1.0f <= t) t = 1.0f, winner = (start + k) % 64;
        depends += winner != 63;
    }
    EXPECT_GT(depends, 0u);
}

} // namespace
} // namespace stromboli::test
