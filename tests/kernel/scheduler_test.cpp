// The two schedulers run the same functions of a path, so that they make the same picture to the
// last bit; and each ends a render that is stopped.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/light_table.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/read_scene.hpp"
#include "shaders/shared/medium_types.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

class SchedulerTest : public DeviceTest {
  protected:
    SchedulerTest() {
        settings_.area.width = 61, settings_.area.height = 37;
        settings_.budget.mostSamplesPerPixel = 4;
    }

    Film pictureOf(const Scene& loaded, const KernelTuning& tuning) const {
        const GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
        const Camera camera = makeCamera(loaded, CameraChoice::Automatic, settings_.area.width,
                                         settings_.area.height);
        VulkanBackend backend(testDevice(), scene, camera, settings_, tuning);
        Film film = render(backend, settings_);
        rays_ = backend.counters().rays;
        paths_ = backend.counters().paths;
        return film;
    }

    /// For few and many paths under way, and with submissions of a single round.
    void expectSamePictures(const Scene& scene) const {
        const Film persistent = pictureOf(scene, {.scheduler = PathScheduler::Persistent});
        const uint64_t rays = rays_, paths = paths_;
        for (const uint32_t lanes : {100u, 4096u}) {
            const Film wavefront =
                pictureOf(scene, {.scheduler = PathScheduler::Wavefront, .lanes = lanes});
            EXPECT_TRUE(sameStatistics(persistent, wavefront)) << lanes << " paths under way";
            EXPECT_EQ(rays_, rays);
            EXPECT_EQ(paths_, paths);
        }
        EXPECT_TRUE(sameStatistics(
            persistent,
            pictureOf(scene, {.scheduler = PathScheduler::Wavefront, .fixedIterations = 1})));
    }

    RenderSettings settings_;
    mutable uint64_t rays_ = 0, paths_ = 0; ///< of the last picture
};

/// One of two sheets faces whoever looks. Rays that have come through it meet nothing, in a medium
/// that absorbs all light but blue.
Scene sheetsBeforeTheSky() {
    scenes::SceneMaker b;
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled.metallic = 0;
    m.principled.transmission = 1;
    m.principled.isThin = false;
    m.principled.roughness = 0.3f;
    m.principled.attenuationColor = {0.5f, 0.1f, 1};
    m.principled.attenuationDistance = 0.3f;
    const uint32_t glass = b.add(m);
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, glass);
    b.quad({1, -1, 0}, {0, 2, 0}, {2, 0, 0}, glass);
    b.add(scenes::ambient(1));
    return b.scene;
}

TEST_F(SchedulerTest, BoxesAndSpheresAreTheSame) {
    expectSamePictures(readScene("cornell_boxes"));
    expectSamePictures(readScene("cornell_mirror_glass"));
}

TEST_F(SchedulerTest, TexturesAndOpacityAreTheSame) {
    expectSamePictures(readScene("texture_chart"));
}

TEST_F(SchedulerTest, PlacementsAreTheSame) {
    expectSamePictures(readScene("generate:forest:8"));
}

TEST_F(SchedulerTest, MediaAreTheSame) {
    expectSamePictures(sheetsBeforeTheSky());
}

/// Light walks under a surface of wax.
Scene waxInTheSky() {
    scenes::SceneMaker b;
    Medium wax = scenes::mediumOf(glm::vec3(0.1f, 0.3f, 1), glm::vec3(6), 0.3f);
    wax.isUnderSurface = true;
    Material surface = scenes::glass(1.4f);
    surface.boundsMedia = true;
    surface.inside = b.add(wax);
    b.sphere({0, 0, 0}, 1, b.add(surface));
    b.add(scenes::ambient(1));
    return b.scene;
}

/// Three volumes as glTF has them, which do not say what is outside, within one another.
Scene volumesThatOverlap() {
    scenes::SceneMaker b;
    for (const float size : {1.0f, 0.75f, 0.5f}) {
        Material volume = scenes::glass(1.2f);
        volume.boundsMedia = volume.outsideIsOpen = true;
        volume.inside = b.add(scenes::mediumOf(glm::vec3(size, 0.25f, 0), glm::vec3(1, size, 2)));
        b.box({-size, -size, -1}, {1, 1, size}, b.add(volume));
    }
    b.add(scenes::ambient(1));
    resolveMedia(b.scene);
    return b.scene;
}

/// Fog on a floor, whose border lies in the floor's plane, and a small lamp in it, about which
/// distances are drawn.
Scene fogOnAFloor() {
    scenes::SceneMaker b;
    b.quad({-3, -3, 0.3f}, {6, 0.1f, 0}, {-0.1f, 6, 0}, b.add(scenes::diffuse(0.5f)));
    b.box({-2, -2, 0.3f}, {2, 2, 1.3f},
          b.add(scenes::border(b.add(scenes::mediumOf(glm::vec3(0.01f), glm::vec3(0.1f))))));
    b.sphere({0.2f, 0.1f, 0.7f}, 0.02f, b.add(scenes::emissive(50)));
    return b.scene;
}

TEST_F(SchedulerTest, WalksUnderSurfacesAreTheSame) {
    settings_.estimator.maxBounces = 3;
    expectSamePictures(waxInTheSky());
}

TEST_F(SchedulerTest, VolumesThatOverlapAreTheSame) {
    const Scene scene = volumesThatOverlap();
    const GpuScene packed = packScene(scene, buildWideBvh(scene));
    EXPECT_NE(packed.media & gpu::MEDIA_OVERLAP, 0u);
    expectSamePictures(scene);
}

TEST_F(SchedulerTest, BordersInPlanesOfSurfacesAreTheSame) {
    const Scene scene = fogOnAFloor();
    EXPECT_EQ(packScene(scene, buildWideBvh(scene)).foci, 1u);
    expectSamePictures(scene);
}

/// Compiled quickly (QUICK_KERNELS): these kernels take longer to compile than all others of this
/// file, which have the driver's compiler optimise both schedulers.
class SchedulerLight : public SchedulerTest {};

TEST_F(SchedulerLight, EveryWayToFindItIsTheSame) {
    const Scene stillLife = readScene("still_life");
    expectSamePictures(stillLife);
    settings_.estimator.lightSamples = 3;
    settings_.estimator.directLight = DirectLight::Hemisphere;
    expectSamePictures(stillLife);
    settings_.estimator.directLight = DirectLight::Mis;
    settings_.estimator.branches = 3;
    settings_.estimator.filter = PixelFilter::Mitchell;
    expectSamePictures(stillLife);
}

TEST_F(SchedulerTest, OtherIntegratorsAreTheSame) {
    for (const Integrator integrator : {Integrator::Normals, Integrator::Depth}) {
        settings_.estimator.integrator = integrator;
        expectSamePictures(readScene("cornell_mesh"));
    }
}

/// A work list in parts, and samples in several passes over it.
TEST_F(SchedulerTest, PartsOfTheWorkAreTheSame) {
    const Scene scene = readScene("cornell_mesh");
    const Film persistent = pictureOf(scene, {.scheduler = PathScheduler::Persistent});
    EXPECT_TRUE(sameStatistics(persistent, pictureOf(scene, {.scheduler = PathScheduler::Wavefront,
                                                             .lanes = 64,
                                                             .itemsPerDispatch = 100})));
}

/// Where a render is stopped, each pixel that was begun has whole samples, all others have none,
/// and the work list is left.
TEST_F(SchedulerTest, AStoppedRenderEndsItsSamples) {
    const Scene loaded = readScene("cornell_boxes");
    const GpuScene scene =
        packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
    const Camera camera = makeCamera(loaded, CameraChoice::Automatic, 61, 37);
    VulkanBackend backend(
        testDevice(), scene, camera, settings_,
        {.scheduler = PathScheduler::Wavefront, .lanes = 64, .fixedIterations = 3});
    Film film(settings_.area);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < 61 * 37; ++i)
        targets.push_back({i, 16});
    int calls = 0;
    uint64_t doneAtStop = 0;
    backend.sample(targets, film, [&](uint64_t done) {
        if (++calls < 10) return true;
        if (calls == 10) doneAtStop = done;
        return false;
    });
    uint64_t samples = 0, begun = 0, ones = 0;
    for (uint32_t i = 0; i < 61 * 37; ++i) {
        samples += film.pixels[i].count;
        begun += film.pixels[i].count > 0;
        ones += film.pixels[i].count == 1;
        EXPECT_LE(film.pixels[i].count, 16u);
    }
    EXPECT_EQ(samples, backend.counters().paths);
    // In the first pass over a pixel only one that has no sample yet ends that under way (Glynn and
    // Heidelberger 1990, shaders/include/path_kernel.glsl).
    EXPECT_LE(samples, doneAtStop + ones);
    EXPECT_GT(begun, 0u);
    EXPECT_LT(begun, 61u * 37u);
    // What is missing is rendered as if nothing had happened.
    backend.sample(targets, film, {});
    for (uint32_t i = 0; i < 61 * 37; ++i)
        EXPECT_EQ(film.pixels[i].count, 16u);
}

} // namespace
} // namespace stromboli
