// The kernel's paths once more by the reference: what their vertices meet and bring is the same.
#include "host/kernel/find_lit_cells.hpp"
#include "host/reference/reference_backend.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/read_scene.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

using namespace test;

class Retracing : public DeviceTest {};

/// Of the vertices' sum, beside the path's own size: directions are floats, which move a light's
/// cosine by 1e-7 and the pdf of rough reflections by as much again for each bounce.
constexpr double kOff = 2e-3;

/// One for each pixel of a picture of 16 by 12.
constexpr uint32_t kPaths = 192;

/// No throughput is 0 / 0, also where roulette ends a path that brings nothing.
void expectFinite(const RecordedVertex& vertex) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isfinite(vertex.throughput[c]));
        EXPECT_TRUE(!vertex.bounce || std::isfinite(vertex.bounce->throughput[c]));
    }
}

TEST_F(Retracing, KernelAndReferenceFindTheSameOnOnePath) {
    // Each is a kernel to compile; together they have all kinds of lights but points and spots.
    for (const char* name : {"cornell_mirror_glass", "cornell_metal", "cornell_mesh",
                             "light_sphere", "light_ambient", "texture_chart", "island"}) {
        SCOPED_TRACE(name);
        const Scene scene = readScene(name);
        RenderSettings s;
        s.area = {16, 12, {}};
        s.estimator.branches = 2;
        s.estimator.directLight = DirectLight::MisAll;
        const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
        const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
        VulkanBackend device(testDevice(), gpu, camera, s);
        const ReferenceBackend host(scene, camera, s);
        ASSERT_TRUE(host.mayRetrace());
        size_t met = 0, agree = 0;
        for (uint32_t i = 0; i < kPaths; ++i) {
            const RecordedPath taken = device.record(i, i), again = host.retrace(taken);
            ASSERT_EQ(again.vertices.size(), taken.vertices.size());
            for (size_t v = 0; v < taken.vertices.size(); ++v) {
                ++met;
                agree += taken.vertices[v].primitive == again.vertices[v].primitive;
                expectFinite(taken.vertices[v]);
                expectFinite(again.vertices[v]);
            }
            EXPECT_LE(glm::length(again.radiance - taken.radiance),
                      kOff * glm::length(taken.radiance))
                << "pixel and sample " << i;
        }
        EXPECT_GE(agree + 1, met) << "an edge may be met on its other side";
    }
}

/// A closed room, which a lamp in a globe of glass lights, and of which every bounce knows its
/// weight only when it has arrived.
TEST_F(Retracing, KnowsWhatAimedBouncesWeigh) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f)), shine = b.add(scenes::emissive(100));
    const glm::vec3 low(-1), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2), at(-0.6f, 0.2f, -0.6f);
    b.quad(low, z, x, white), b.quad(low + y, x, z, white), b.quad(low, y, z, white);
    b.quad(low + x, z, y, white), b.quad(low, x, y, white), b.quad(low + z, y, x, white);
    b.quad({-0.4f, -1, 0}, {0, 1.5f, 0}, {0.8f, 0, 0}, white); // in the way
    Material glass;
    glass.kind = MaterialKind::Dielectric;
    glass.ior = 1.5f;
    b.sphere(at, 0.2f, b.add(glass));
    glass.ior = 1 / 1.5f;
    b.sphere(at, 0.18f, b.add(glass));
    b.sphere(at, 0.15f, shine);
    RenderSettings s;
    s.area = {16, 12, {}};
    s.estimator.branches = 2;
    const Camera camera = lookingAt({0.9, 0.6, 0.9}, {-0.5, -0.2, -0.5}, 0.9);
    GpuScene gpu = packScene(b.scene, buildWideBvh(b.scene), lightSelection(s.estimator));
    gpu.lit = findLitCells(gpu);
    VulkanBackend device(testDevice(), gpu, camera, s);
    ASSERT_NE(device.features()[SPEC_AIMS_BOUNCES], 0u);
    const ReferenceBackend host(b.scene, camera, s);
    size_t lost = 0, lit = 0;
    for (uint32_t i = 0; i < kPaths; ++i) {
        const RecordedPath taken = device.record(i, i), again = host.retrace(taken);
        ASSERT_EQ(again.vertices.size(), taken.vertices.size());
        for (const RecordedVertex& v : taken.vertices)
            lost += v.aimedWeight == 0;
        lit += glm::length(taken.radiance) > 0;
        EXPECT_LE(glm::length(again.radiance - taken.radiance), kOff * glm::length(taken.radiance))
            << "pixel and sample " << i;
    }
    EXPECT_GT(lost, 0u) << "some aim at what is behind something else";
    EXPECT_GT(lit, kPaths / 8);
}

/// A room with a wall of glass, a lamp behind it, and light samples that go through.
TEST_F(Retracing, FollowsLightSamplesThroughGlass) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f)), shine = b.add(scenes::emissive(30));
    const glm::vec3 low(-1), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    b.quad(low, z, x, white), b.quad(low + y, x, z, white), b.quad(low, y, z, white);
    b.quad(low + x, z, y, white), b.quad(low, x, y, white), b.quad(low + z, y, x, white);
    Material glass;
    glass.kind = MaterialKind::Dielectric;
    glass.ior = 1.5f;
    const uint32_t solid = b.add(glass);
    b.quad({0.2f, -1, -1}, z, y, solid), b.quad({0.5f, -1, -1}, y, z, solid);
    glass.kind = MaterialKind::ThinDielectric;
    b.quad({0.6f, -1, -1}, y, z, b.add(glass));
    b.sphere({0.8f, 0.1f, 0.1f}, 0.1f, shine);
    RenderSettings s;
    s.area = {16, 12, {}};
    s.estimator.branches = 2;
    s.estimator.directLight = DirectLight::MisAll;
    const Camera camera = lookingAt({-0.9, 0.5, 0.8}, {0, -0.4, -0.2}, 0.9);
    GpuScene gpu = packScene(b.scene, buildWideBvh(b.scene), lightSelection(s.estimator));
    gpu.glassBeforeLights = 1;
    VulkanBackend device(testDevice(), gpu, camera, s);
    ASSERT_NE(device.features()[SPEC_LIGHT_THROUGH_GLASS], 0u);
    const ReferenceBackend host(b.scene, camera, s);
    size_t arrive = 0;
    for (uint32_t i = 0; i < kPaths; ++i) {
        const RecordedPath taken = device.record(i, i), again = host.retrace(taken);
        ASSERT_EQ(again.vertices.size(), taken.vertices.size());
        for (const RecordedVertex& v : taken.vertices)
            for (const RecordedLight& light : v.lights)
                arrive += light.fate == RecordedLight::Fate::Arrives;
        EXPECT_LE(glm::length(again.radiance - taken.radiance), kOff * glm::length(taken.radiance))
            << "pixel and sample " << i;
    }
    EXPECT_GT(arrive, kPaths);
}

/// A dark room and a lit one, with a gap between them, seen from the dark one.
Scene roomBesideALitOne() {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.7f)), shine = b.add(scenes::emissive(50));
    const glm::vec3 low(-1), x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
    b.quad(low, z, x, white), b.quad(low + y, x, z, white), b.quad(low, y, z, white);
    b.quad(low + x, z, y, white), b.quad(low, x, y, white), b.quad(low + z, y, x, white);
    b.quad({0, -1, -1}, {0, 2, 0}, {0, 0, 1.6f}, white);
    b.sphere({0.6f, 0.5f, -0.6f}, 0.1f, shine);
    return b.scene;
}

/// Roulette by throughput spares what comes to where it is bright, as the documents say it does.
TEST_F(Retracing, RouletteSparesPathsWhereItIsBright) {
    const Scene scene = roomBesideALitOne();
    RenderSettings s;
    s.area = {32, 24, {}};
    s.estimator.branches = 1;
    s.estimator.gapProposal = false;
    s.estimator.maxBounces = 12;
    const Camera camera = lookingAt({-0.9, 0.5, 0.8}, {-0.3, -0.4, -0.5}, 0.9);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    VulkanBackend device(testDevice(), gpu, camera, s);
    const auto largest = [](const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); };
    size_t asked = 0, spared = 0;
    for (uint32_t i = 0; i < s.area.pixelCount(); ++i) {
        double brightness = 0;
        glm::dvec3 radiance(0);
        const RecordedPath path = device.record(i, i);
        for (size_t v = 0; v < path.vertices.size(); ++v) {
            const RecordedVertex& at = path.vertices[v];
            radiance += at.light;
            for (const RecordedLight& light : at.lights) {
                radiance += light.light;
                if (light.fate == RecordedLight::Fate::Arrives)
                    brightness = std::max(brightness, largest(light.light / at.throughput));
            }
            if (at.bounce && v + 1 >= Roulette().throughputStart) {
                const double throughput = largest(at.bounce->throughput) * at.bounce->goesOn,
                             beside = 4 * brightness / std::max(largest(radiance), 1e-30),
                             expected = std::min(1.0, throughput * std::max(3.0, beside));
                EXPECT_NEAR(at.bounce->goesOn, expected, 1e-4 * expected) << i << " " << v;
                ++asked;
                spared += at.bounce->goesOn > 1.5 * std::min(1.0, 3 * throughput);
            }
            brightness *= 0.5;
        }
    }
    EXPECT_GT(asked, s.area.pixelCount());
    EXPECT_GT(spared, asked / 100);
}

/// Rays of both pass the same surfaces, also where they meet nothing in the end.
TEST_F(Retracing, PassesWhatIsPartlyThere) {
    Scene scene = readScene("cornell_boxes");
    for (Material& m : scene.materials)
        if (!m.emits()) m.alphaMode = AlphaMode::Blend, m.opacity = 0.5f;
    RenderSettings s;
    s.area = {16, 12, {}};
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    VulkanBackend device(testDevice(), gpu, camera, s);
    const ReferenceBackend host(scene, camera, s);
    size_t missed = 0;
    for (uint32_t i = 0; i < 12; ++i) {
        const RecordedPath taken = device.record(i * 16 + 8, i), again = host.retrace(taken);
        ASSERT_EQ(again.vertices.size(), taken.vertices.size());
        for (size_t v = 0; v < taken.vertices.size(); ++v) {
            EXPECT_EQ(again.vertices[v].primitive, taken.vertices[v].primitive) << i << ' ' << v;
            missed += taken.vertices[v].met == RecordedVertex::Met::Nothing;
        }
        EXPECT_LE(glm::length(again.radiance - taken.radiance), kOff * glm::length(taken.radiance));
    }
    EXPECT_GT(missed, 0u);
}

/// What the kernel would get wrong is seen: a light twice as bright, a colour that is another.
TEST_F(Retracing, FindsWhatDiffers) {
    Scene scene = readScene("cornell_boxes");
    RenderSettings s;
    s.area = {16, 12, {}};
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    VulkanBackend device(testDevice(), gpu, camera, s);
    const RecordedPath taken = device.record(8 * 16 + 8, 1);
    ASSERT_GT(glm::length(taken.radiance), 0);
    for (Material& m : scene.materials)
        m.emission *= 2;
    const ReferenceBackend brighter(scene, camera, s);
    const RecordedPath doubled = brighter.retrace(taken);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(doubled.radiance[c], 2 * taken.radiance[c], 1e-4 * taken.radiance[c]);
}

TEST_F(Retracing, MediaAndOtherRulesAreNotFollowed) {
    Scene scene = readScene("cornell_boxes");
    RenderSettings s;
    s.area = {16, 12, {}};
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    scene.media.emplace_back();
    const ReferenceBackend host(scene, camera, s);
    EXPECT_FALSE(host.mayRetrace());
    EXPECT_THROW(host.retrace({}), std::invalid_argument);
}

/// However the kernel reads the scene, is cut into dispatches, or is asked to be scheduled.
TEST_F(Retracing, RecordsDoNotDependOnTheTuning) {
    const Scene scene = readScene("cornell_mirror_glass");
    RenderSettings s;
    s.area = {16, 12, {}};
    s.estimator.branches = 2;
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    KernelTuning plain, storage, short_, waves;
    storage.texelFetch = false;
    short_.fixedIterations = 3;
    waves.scheduler = PathScheduler::Wavefront;
    constexpr uint32_t kPixel = 100, kSample = 2;
    const RecordedPath path =
        VulkanBackend(testDevice(), gpu, camera, s, plain).record(kPixel, kSample);
    EXPECT_GT(path.vertices.size(), 3u);
    for (const KernelTuning& tuning : {storage, short_, waves}) {
        VulkanBackend device(testDevice(), gpu, camera, s, tuning);
        const RecordedPath other = device.record(kPixel, kSample);
        EXPECT_EQ(other.radiance, path.radiance);
        ASSERT_EQ(other.vertices.size(), path.vertices.size());
        for (size_t v = 0; v < path.vertices.size(); ++v) {
            EXPECT_EQ(other.vertices[v].position, path.vertices[v].position);
            EXPECT_EQ(other.vertices[v].throughput, path.vertices[v].throughput);
            EXPECT_EQ(other.vertices[v].light, path.vertices[v].light);
            EXPECT_EQ(other.vertices[v].lights.size(), path.vertices[v].lights.size());
        }
    }
}

/// All at once and one by one, in whatever order.
TEST_F(Retracing, SamplesAloneAreThoseOfThePicture) {
    const Scene scene = readScene("cornell_metal");
    RenderSettings s;
    s.area = {16, 12, {}};
    s.estimator.branches = 2;
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    VulkanBackend device(testDevice(), gpu, camera, s);
    constexpr uint32_t kPixel = 100, kFirst = 3, kCount = 70;
    const std::vector<SampleValue> together = device.samplesAlone(kPixel, kFirst, kCount);
    ASSERT_EQ(together.size(), kCount);
    for (uint32_t i = 0; i < kCount; ++i)
        EXPECT_EQ(together[i].radiance, device.sampleAlone(kPixel, kFirst + i).radiance) << i;
}

} // namespace
} // namespace stromboli
