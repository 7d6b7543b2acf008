// The rays that contestants trace: what they are is known of each of them.
#include "host/bench/device_rays.hpp"
#include "host/reference/bvh.hpp"
#include "scene/model/emitters.hpp"
#include "tests/bench/bench_fixtures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace stromboli::bench {
namespace {

using test::LibraryPicture;
using test::libraryPicture;

RaySets raysOf(const LibraryPicture& p, uint32_t perPixel = 1) {
    return makeRaySets(p.scene, p.camera, p.settings, perPixel);
}

bool sameBits(const RaySet& a, const RaySet& b) {
    return a.rays.size() == b.rays.size() &&
           std::memcmp(a.rays.data(), b.rays.data(), a.rays.size() * sizeof a.rays[0]) == 0;
}

double largestCoordinate(const glm::vec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

/// Least distance of a point from any of the scene's planes and spheres. Rays start on one of them.
double distanceToSurfaces(const Scene& scene, const glm::vec3& point) {
    const glm::dvec3 p(point);
    double least = INFINITY;
    for (const Triangle& t : scene.triangles) {
        const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                         c = scene.positions[t.corner[2]];
        const glm::dvec3 n = glm::normalize(glm::cross(b - a, c - a));
        least = std::min(least, std::abs(glm::dot(p - a, n)));
    }
    for (const Sphere& s : scene.spheres)
        least = std::min(least, std::abs(glm::length(p - glm::dvec3(s.center)) - s.radius));
    return least;
}

class RaySetsOf : public testing::TestWithParam<const char*> {
  protected:
    const LibraryPicture picture = libraryPicture(GetParam());
    const RaySets sets = raysOf(picture);
};

TEST_P(RaySetsOf, CameraRaysArePerPixelAndUnit) {
    EXPECT_EQ(sets.camera.rays.size(), 48u * 36u);
    EXPECT_FALSE(sets.camera.anyHit);
    for (const gpu::TracedRay& ray : sets.camera.rays) {
        // A unit vector rounded to float: three times half an ulp.
        EXPECT_NEAR(glm::length(glm::dvec3(ray.direction)), 1, 0x1p-23);
        EXPECT_EQ(ray.origin, glm::vec3(picture.camera.position));
    }
}

/// The offset is 32 u of the largest coordinate, and the origin is rounded to float after it (u / 2
/// for each component).
TEST_P(RaySetsOf, BounceAndShadowRaysStartOffASurfaceByTheBound) {
    for (const RaySet* set : {&sets.bounce, &sets.shadow}) {
        size_t nearer = 0;
        for (const gpu::TracedRay& ray : set->rays) {
            const double u = 0x1p-24 * largestCoordinate(ray.origin);
            const double distance = distanceToSurfaces(picture.scene, ray.origin);
            EXPECT_LE(distance, 34 * u);
            nearer += distance < 30 * u ? 1 : 0;
        }
        EXPECT_LE(nearer, set->rays.size() / 100); // where two planes meet
    }
}

TEST_P(RaySetsOf, BounceRaysAreUnitAndLeaveTheirSurface) {
    EXPECT_GT(sets.bounce.rays.size(), sets.camera.rays.size() / 4);
    const reference::Bvh bvh(picture.scene);
    size_t stuck = 0;
    for (const gpu::TracedRay& ray : sets.bounce.rays) {
        EXPECT_NEAR(glm::length(glm::dvec3(ray.direction)), 1, 0x1p-23);
        // A ray into the surface it starts on would end after some 32 u of the coordinates.
        const reference::Hit hit = bvh.closest({ray.origin, ray.direction}, {});
        stuck += hit.t < 0x1p-16 * largestCoordinate(ray.origin) ? 1 : 0;
    }
    // Some meet a neighbouring surface in a corner of the room.
    EXPECT_LE(stuck, sets.bounce.rays.size() / 500);
}

TEST_P(RaySetsOf, ArePureFunctions) {
    const RaySets again = raysOf(picture);
    EXPECT_TRUE(sameBits(sets.camera, again.camera));
    EXPECT_TRUE(sameBits(sets.shadow, again.shadow));
    EXPECT_TRUE(sameBits(sets.bounce, again.bounce));
    LibraryPicture other = picture;
    other.settings.estimator.seed = 1;
    EXPECT_FALSE(sameBits(sets.camera, raysOf(other).camera));
}

INSTANTIATE_TEST_SUITE_P(Scenes, RaySetsOf,
                         testing::Values("cornell_boxes", "cornell_spheres", "light_mesh"),
                         [](const auto& test) { return std::string(test.param); });

/// The emitter of the Cornell box is one quad.
TEST(RaySets, ShadowRaysEndJustBeforeTheEmitter) {
    const LibraryPicture picture = libraryPicture("cornell_boxes");
    const RaySets sets = raysOf(picture);
    const std::vector<Emitter> emitters = collectEmitters(picture.scene);
    ASSERT_EQ(emitters.size(), 1u);
    ASSERT_EQ(emitters[0].kind, EmitterKind::Quad);
    const glm::dvec3 corner = emitters[0].corner, a = emitters[0].edgeA, b = emitters[0].edgeB;
    EXPECT_TRUE(sets.shadow.anyHit);
    EXPECT_GT(sets.shadow.rays.size(), sets.bounce.rays.size() / 4);
    for (const gpu::TracedRay& ray : sets.shadow.rays) {
        EXPECT_EQ(ray.tMax, 1 - 0x1p-12f);
        const glm::dvec3 end = glm::dvec3(ray.origin) + glm::dvec3(ray.direction) - corner;
        const double u = glm::dot(end, a) / glm::dot(a, a), v = glm::dot(end, b) / glm::dot(b, b);
        EXPECT_TRUE(u > -1e-4 && u < 1 + 1e-4 && v > -1e-4 && v < 1 + 1e-4) << u << " " << v;
    }
}

/// On a floor the mean cosine of cosine-distributed directions is 2/3 and its variance 1/18.
TEST(RaySets, BouncesAreCosineDistributed) {
    const LibraryPicture picture = libraryPicture("light_directional", 64, 64);
    const RaySets sets = raysOf(picture, 4);
    double sum = 0;
    size_t count = 0;
    for (const gpu::TracedRay& ray : sets.bounce.rays)
        if (std::abs(ray.origin.y) < 1e-3f && ray.direction.y > 0) { // on the ground, y = 0
            sum += double(ray.direction.y);
            ++count;
        }
    ASSERT_GT(count, 1000u);
    const double sigma = std::sqrt(1.0 / 18 / double(count));
    EXPECT_NEAR(sum / double(count), 2.0 / 3, 4.5 * sigma); // false alarm 7e-6
}

} // namespace
} // namespace stromboli::bench
