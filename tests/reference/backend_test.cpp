#include "host/reference/reference_backend.hpp"
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace stromboli {
namespace {

using namespace test;

const Camera kCamera = pointCamera({0.5, 0.5, 0.95}, {0.5, 0.4, 0}, 0.8);

void expectEqualFilms(const Film& a, const Film& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        EXPECT_EQ(a.pixels[i].count, b.pixels[i].count);
        EXPECT_EQ(a.pixels[i].mean, b.pixels[i].mean);
        EXPECT_EQ(a.pixels[i].m2, b.pixels[i].m2);
    }
}

TEST(ReferenceBackend, EveryNumberOfThreadsGivesTheSameFilm) {
    const Scene scene = cornellBox();
    const RenderSettings s = smallPicture(8, 5);
    const Film one = renderFilm(scene, kCamera, s, 1);
    EXPECT_GT(one.at(8, 8).mean.x, 0);
    for (unsigned threads : {2u, 3u, 0u})
        expectEqualFilms(renderFilm(scene, kCamera, s, threads), one);
}

TEST(ReferenceBackend, PassesDoNotChangeTheFilm) {
    const Scene scene = cornellBox();
    const RenderSettings s = smallPicture(16, 5);
    ReferenceBackend backend(scene, kCamera, s);
    Film film(s.area.width, s.area.height);
    const auto pass = [&](uint32_t first, uint32_t step, uint32_t samples) {
        std::vector<PixelTarget> targets;
        for (uint32_t i = first; i < film.pixels.size(); i += step)
            targets.push_back({i, samples});
        backend.sample(targets, film, {});
    };
    pass(0, 2, 5);
    pass(1, 3, 1);
    pass(0, 1, 11);
    pass(0, 5, 7); // has them already
    pass(0, 1, 16);
    expectEqualFilms(film, renderFilm(scene, kCamera, s));
}

TEST(ReferenceBackend, SeedsAreIndependent) {
    const Scene scene = cornellBox();
    RenderSettings s = smallPicture(4, 2);
    const Film a = renderFilm(scene, kCamera, s);
    s.estimator.seed = 1;
    const Film b = renderFilm(scene, kCamera, s);
    EXPECT_NE(a.at(3, 3).mean, b.at(3, 3).mean);
}

TEST(ReferenceBackend, CountsPathsAndRays) {
    SceneMaker b;
    addFloor(b, b.add(diffuse(0.5f)));
    b.scene.lights.emplace_back().kind = LightKind::Directional;
    b.scene.lights.back().direction = {0, -1, 0};
    ReferenceBackend backend(b.scene, pointCamera({0, 3, 1}, {0, 0, 0}), smallPicture(4, 1));
    Film film(16, 16);
    const std::vector<PixelTarget> targets{{0, 4}, {17, 4}, {255, 2}};
    uint64_t reported = 0;
    backend.sample(targets, film, [&](uint64_t done) {
        reported = done;
        return true;
    });
    EXPECT_EQ(backend.counters().paths, 10u);
    EXPECT_EQ(backend.counters().rays, 20u) << "one camera and one shadow ray each";
    EXPECT_EQ(reported, 10u);
    EXPECT_EQ(film.pixels[255].count, 2u);
    EXPECT_EQ(film.pixels[1].count, 0u);
}

TEST(ReferenceBackend, StopsWhenAsked) {
    const Scene scene = cornellBox();
    ReferenceBackend backend(scene, kCamera, smallPicture(1000000, 5));
    Film film(16, 16);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < 256; ++i)
        targets.push_back({i, 1000000});
    backend.sample(targets, film, [](uint64_t) { return false; });
    uint64_t taken = 0;
    for (const PixelStatistics& p : film.pixels)
        taken += p.taken();
    EXPECT_GT(taken, 0u);
    EXPECT_LT(taken, 100000u);
    EXPECT_EQ(backend.counters().paths, taken);
}

TEST(ReferenceBackend, RefusesWhatItCannotRender) {
    Scene scene;
    scene.lights.emplace_back().kind = LightKind::Area;
    RenderSettings s = smallPicture(1, 1);
    EXPECT_THROW(ReferenceBackend(scene, kCamera, s), std::invalid_argument);
    s.estimator.conventions.samplesEmitters = false;
    ReferenceBackend backend(scene, kCamera, s);
    Film film(16, 16), other(8, 8);
    const std::vector<PixelTarget> outside{{256, 1}}, inside{{0, 1}};
    EXPECT_THROW(backend.sample(outside, film, {}), std::invalid_argument);
    EXPECT_THROW(backend.sample(inside, other, {}), std::invalid_argument);
    s.estimator.lightSamples = 0;
    EXPECT_THROW(ReferenceBackend(scene, kCamera, s), std::invalid_argument);
}

/// A red emitter on the upper left, seen in a picture of 4 x 2.
TEST(ReferenceBackend, RowsGoDownAndColumnsToTheRight) {
    SceneMaker b;
    b.quad({-1, 0, -5}, {0.5f, 0, 0}, {0, 0.5f, 0}, b.add(emissive(1)));
    Camera camera;
    camera.orthographic = true;
    camera.halfHeight = 0.5;
    RenderSettings s = smallPicture(4, 0);
    s.area.width = 4, s.area.height = 2;
    const Film film = renderFilm(b.scene, camera, s);
    for (uint32_t y = 0; y < 2; ++y)
        for (uint32_t x = 0; x < 4; ++x)
            EXPECT_EQ(film.at(x, y).mean.x, x == 0 && y == 0 ? 1 : 0) << x << ", " << y;
}

TEST(ReferenceBackend, PerspectiveSeesHalfWidthAtDistanceOne) {
    SceneMaker b;
    b.quad({-0.5f, -0.5f, -2}, {1, 0, 0}, {0, 1, 0}, b.add(emissive(1)));
    Camera camera;
    camera.halfWidth = 1; // 4 x 2 at distance 2
    camera.halfHeight = 0.5;
    expectMean(estimate(b.scene, camera, smallPicture(64, 0)), 1.0 / 8);
}

TEST(ReferenceBackend, ClipsAlongTheAxisOrTheRay) {
    // At 45 degrees a plane at depth 2 is 2.83 away along the ray.
    SceneMaker b;
    b.quad({-10, -10, -2}, {20, 0, 0}, {0, 20, 0}, b.add(emissive(1)));
    Camera camera = pointCamera({0, 0, 0}, {0, 0, -1});
    const auto seen = [&](double near, double far, bool alongRay) {
        camera.nearDistance = near, camera.farDistance = far, camera.clipAlongRay = alongRay;
        camera.halfWidth = 2; // pixel 12 of 16 looks along x = 1.0 to 1.25
        return renderFilm(b.scene, camera, smallPicture(1, 0)).at(12, 8).mean.x;
    };
    EXPECT_EQ(seen(0, 2.01, false), 1);
    EXPECT_EQ(seen(0, 1.99, false), 0);
    EXPECT_EQ(seen(1.99, 9, false), 1);
    EXPECT_EQ(seen(2.01, 9, false), 0);
    EXPECT_EQ(seen(0, 2.8, true), 0);
    EXPECT_EQ(seen(2.8, 3.3, true), 1);
}

TEST(ReferenceBackend, NormalsPicture) {
    SceneMaker b;
    b.triangle({-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, b.add(diffuse(0.5f)));
    RenderSettings s = smallPicture(2, 3);
    s.estimator.integrator = Integrator::Normals;
    const Camera front = pointCamera({0, 0, 5}, {0, 0, 0});
    const Camera behind = pointCamera({0, 0, -5}, {0, 0, 0});
    const Camera away = pointCamera({0, 0, 5}, {0, 0, 9});
    expectMean(estimate(b.scene, front, s), {0.5, 0.5, 1});
    expectMean(estimate(b.scene, behind, s), {0.5, 0.5, 1}); // not flipped
    expectMean(estimate(b.scene, away, s), 0);
    b.scene.normals = {{0, 0.6f, 0.8f}};
    for (uint32_t& n : b.scene.triangles[0].normals)
        n = 0;
    const Estimate shaded = estimate(b.scene, front, s);
    EXPECT_NEAR(shaded.mean.y, 0.8, 1e-6);
    EXPECT_NEAR(shaded.mean.z, 0.9, 1e-6);
}

} // namespace
} // namespace stromboli
