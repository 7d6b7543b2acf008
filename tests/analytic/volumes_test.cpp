// Volumes that say only what is inside of them, and that overlap (docs/theory/media.md, "Where a
// ray is"): of those in which a place is, the smallest one counts.
#include "tests/analytic/media.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

/// A border that states no outside.
Material openBorder(uint32_t inside) {
    Material m = border(inside);
    m.outsideIsOpen = true;
    return m;
}

/// Boxes that are as wide as they reach far along x, in a room of radiance 1.
struct Boxes {
    SceneMaker b;

    Boxes() { b.box({-20, -20, -20}, {20, 20, 20}, b.add(emissive(1)), true); }
    uint32_t material(const glm::vec3& absorption) {
        return b.add(openBorder(b.add(mediumOf(absorption))));
    }
    void add(float from, float to, uint32_t material) {
        const float half = 0.5f * (to - from);
        b.box({from, -half, -half}, {to, half, half}, material);
    }
    /// What is seen through all of them, from either end.
    void expect(const glm::dvec3& depth) {
        resolveMedia(b.scene);
        for (const double side : {-1.0, 1.0}) {
            const Camera camera = pointCamera({15 * side, 0.03, 0.02}, {-15 * side, 0.03, 0.02});
            const glm::dvec3 seen = estimate(b.scene, camera, smallPicture(1, 1)).mean;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen[c] / exponential(depth)[c], 1, 1e-4) << side << ' ' << c;
        }
    }
};

const glm::vec3 kThin(0.125f, 0.25f, 0.0625f), kMiddle(0.5f, 0.125f, 0.25f), kDense(1, 0.5f, 0.75f);

TEST(Volumes, TheSmallerOneCounts) {
    Boxes boxes;
    boxes.add(-4, 1, boxes.material(kThin));
    boxes.add(-1, 3, boxes.material(kDense));
    boxes.expect(3.0 * glm::dvec3(kThin) + 4.0 * glm::dvec3(kDense));
}

TEST(Volumes, LieInEachOther) {
    Boxes boxes;
    boxes.add(-1, 1, boxes.material(kDense));
    boxes.add(-4, 3, boxes.material(kThin));
    boxes.add(-2, 2, boxes.material(kMiddle));
    boxes.expect(3.0 * glm::dvec3(kThin) + 2.0 * glm::dvec3(kMiddle) + 2.0 * glm::dvec3(kDense));
}

/// Two of one kind, which rays enter twice and leave twice, with a clear one in both.
TEST(Volumes, AreEnteredTwice) {
    Boxes boxes;
    const uint32_t thin = boxes.material(kThin);
    boxes.add(-4, 1, thin);
    boxes.add(-1, 3, thin);
    boxes.add(-0.5f, 0.5f, boxes.b.add(openBorder(kNoMedium)));
    boxes.expect(6.0 * glm::dvec3(kThin));
}

/// Faces lie in one plane, whatever the order in which they are met.
TEST(Volumes, ShareFaces) {
    Boxes boxes;
    const uint32_t thin = boxes.material(kThin);
    boxes.add(-4, 1, thin);
    boxes.add(-2, 1, boxes.material(kDense));
    boxes.add(1, 3, boxes.material(kMiddle));
    boxes.expect(2.0 * glm::dvec3(kThin) + 3.0 * glm::dvec3(kDense) + 2.0 * glm::dvec3(kMiddle));
}

/// Four are known at a time: of five, the largest one is forgotten behind the others.
TEST(Volumes, FourAreKnownAtATime) {
    Boxes boxes;
    std::vector<glm::vec3> absorptions;
    for (int i = 0; i < 5; ++i) {
        absorptions.push_back(glm::vec3(0.0625f * float(i + 1), 0.25f, 0.125f));
        boxes.add(float(i - 6), float(6 - i), boxes.material(absorptions.back()));
    }
    glm::dvec3 depth(absorptions[0]);
    for (int i = 1; i < 4; ++i)
        depth += 2.0 * glm::dvec3(absorptions[size_t(i)]);
    boxes.expect(depth + 4.0 * glm::dvec3(absorptions[4]));
}

/// A camera in one of them, and light samples through both.
TEST(Volumes, SurroundCamerasAndDimLights) {
    Boxes boxes;
    boxes.add(-4, 1, boxes.material(kThin));
    boxes.add(-1, 3, boxes.material(kDense));
    resolveMedia(boxes.b.scene);
    Camera inside = pointCamera({-3, 0.03, 0.02}, {15, 0.03, 0.02});
    inside.medium = mediumAt(boxes.b.scene, inside.position);
    glm::dvec3 seen = estimate(boxes.b.scene, inside, smallPicture(1, 1)).mean;
    glm::dvec3 depth = 2.0 * glm::dvec3(kThin) + 4.0 * glm::dvec3(kDense);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c] / exponential(depth)[c], 1, 1e-4) << c;

    Boxes lit;
    lit.b.scene.materials[0] = diffuse(0);
    lit.add(-4, 1, lit.material(kThin));
    lit.add(-1, 3, lit.material(kDense));
    lit.b.quad({4, -1, -1}, {0, 0, 2}, {0, 2, 0}, lit.b.add(diffuse(0.5f)));
    resolveMedia(lit.b.scene);
    Light l;
    l.position = {-6, 0, 0};
    l.constantAttenuation = 0;
    l.quadraticAttenuation = 1;
    lit.b.add(l);
    const Camera wall = pointCamera({3.5, 0.03, 0.02}, {4, 0.03, 0.02});
    seen = estimate(lit.b.scene, wall, smallPicture(1, 1)).mean;
    depth = 3.0 * glm::dvec3(kThin) + 4.0 * glm::dvec3(kDense);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(seen[c] / (0.5 / kPi / 100 * exponential(depth)[c]), 1, 1e-3) << c;
}

/// Behind one in fog whose border states both sides there is fog again, whatever else the scene
/// has; also where the fog's border is in two parts, neither of which is around it.
TEST(Volumes, StandInFogThatStatesItsSides) {
    Boxes boxes;
    boxes.add(-4, 3, boxes.b.add(border(boxes.b.add(mediumOf(kThin)))));
    boxes.add(-2, 1, boxes.b.add(openBorder(kNoMedium)));
    boxes.expect(4.0 * glm::dvec3(kThin));

    Boxes planes;
    const uint32_t fog = planes.b.add(border(planes.b.add(mediumOf(kThin))));
    planes.b.quad({-4, -9, -9}, {0, 0, 18}, {0, 18, 0}, fog);
    planes.b.quad({3, -9, -9}, {0, 18, 0}, {0, 0, 18}, fog);
    planes.add(-2, 1, planes.material(kDense));
    planes.expect(4.0 * glm::dvec3(kThin) + 3.0 * glm::dvec3(kDense));
}

/// Where volumes do not overlap, nothing of this is in the scene.
TEST(Volumes, StandApart) {
    Boxes boxes;
    boxes.add(-4, -1, boxes.material(kThin));
    boxes.add(1, 3, boxes.material(kDense));
    boxes.expect(3.0 * glm::dvec3(kThin) + 2.0 * glm::dvec3(kDense));
    for (const Material& m : boxes.b.scene.materials)
        EXPECT_FALSE(m.outsideIsOpen);
}

} // namespace
} // namespace stromboli
