// Kernel and reference see the same in the bundled scenes: albedo, normals, positions, texture
// coordinates and numbers, by z-tests of the mean difference of pixels, which are independent. 4.5
// standard errors, 18 channels in four scenes: false alarm below 1e-3 in all, fixed seeds.
#include "host/reference/reference_backend.hpp"
#include "host/render/layers.hpp"
#include "scene/read_scene.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

const std::vector<Layer> kAll = {Layer::Albedo, Layer::Normal, Layer::Depth,   Layer::Position,
                                 Layer::Uv,     Layer::Object, Layer::Material};

class SeeingOnDevice : public DeviceTest {};

struct Seen {
    FloatImage layers;
    std::vector<double> coverage;

    Seen(Viewer& viewer, const Scene& scene, const Camera& camera, const PictureArea& area)
        : layers(area) {
        const std::vector<uint32_t> samples(area.pixelCount(), kLayerSamples);
        addLayers(layers, kAll, 0, viewer.see(0, samples, Seeing::Surfaces), scene, camera);
        for (const SeenPixel& p : viewer.see(0, samples, Seeing::Coverage))
            coverage.push_back(p.coverage());
    }
};

/// What is infinite is where nothing is seen, which has a test of its own.
double finite(double x) {
    return std::isfinite(x) ? x : 0;
}

template <class A, class B>
void expectSameMean(const A& a, const B& b, const std::string& what) {
    const double n = double(a.size());
    double sum = 0, squares = 0, size = 0;
    for (size_t i = 0; i < a.size(); ++i) {
        const double d = finite(double(a[i])) - finite(double(b[i]));
        sum += d;
        squares += d * d;
        size = std::max(size, std::abs(finite(double(b[i]))));
    }
    const double mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_LE(std::abs(mean), 4.5 * error + 1e-5 * size) << what;
}

TEST_F(SeeingOnDevice, KernelAndReferenceAgree) {
    for (const char* name : {"still_life", "texture_chart", "cornell_mesh", "cornell_spheres"}) {
        SCOPED_TRACE(name);
        const Scene scene = readScene(name);
        RenderSettings s;
        s.area = {48, 36, {}};
        const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
        const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
        VulkanBackend device(testDevice(), gpu, camera, s);
        ReferenceBackend host(scene, camera, s);
        const Seen a(device, scene, camera, s.area), b(host, scene, camera, s.area);
        expectSameMean(a.coverage, b.coverage, "coverage");
        for (const auto& [channel, values] : a.layers.channels)
            expectSameMean(values, b.layers.channels.at(channel), channel);
    }
}

/// What shares count of alpha: rays from any sample on, of which those in a row add up.
TEST_F(SeeingOnDevice, RaysFromAnySampleOnAddUp) {
    const Scene scene = readScene("still_life");
    RenderSettings s;
    s.area = {24, 18, {}};
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    VulkanBackend device(testDevice(), gpu, camera, s);
    ReferenceBackend host(scene, camera, s);
    device.beginAt(1000); // where samples are taken is another matter
    const std::vector<uint32_t> five(s.area.pixelCount(), 5), eleven(five.size(), 11),
        all(five.size(), 16);
    for (Viewer* viewer : {static_cast<Viewer*>(&device), static_cast<Viewer*>(&host)}) {
        const auto first = viewer->see(0, five, Seeing::Coverage);
        const auto rest = viewer->see(0, eleven, Seeing::Coverage, 5);
        const auto again = viewer->see(0, five, Seeing::Coverage, 5);
        const auto whole = viewer->see(0, all, Seeing::Coverage);
        size_t different = 0, partly = 0;
        for (size_t i = 0; i < all.size(); ++i) {
            ASSERT_EQ(first[i].hits + rest[i].hits, whole[i].hits) << i;
            different += first[i].hits != again[i].hits;
            partly += whole[i].hits > 0 && whole[i].hits < 16;
        }
        EXPECT_GT(partly, 0u);
        EXPECT_GT(different, 0u);
    }
}

/// However they are fetched, whichever scheduler serves the lanes, and wherever dispatches end:
/// rays wait for the next one at leaves that are partly there and behind glass.
TEST_F(SeeingOnDevice, DoesNotDependOnTheWayItIsRun) {
    const Scene scene = readScene("still_life");
    RenderSettings s;
    s.area = {24, 18, {}};
    const Camera camera = makeCamera(scene, {}, s.area.width, s.area.height);
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    std::vector<FloatImage> images;
    const KernelTuning ways[] = {{.texelFetch = true},
                                 {.texelFetch = false, .traversalSteps = 3},
                                 {.scheduler = PathScheduler::Wavefront},
                                 {.scheduler = PathScheduler::Wavefront,
                                  .lanes = 64,
                                  .itemsPerDispatch = 100,
                                  .fixedIterations = 3},
                                 {.lanes = 64, .itemsPerDispatch = 100, .fixedIterations = 2}};
    for (const KernelTuning& tuning : ways) {
        VulkanBackend device(testDevice(), gpu, camera, s, tuning);
        images.push_back(Seen(device, scene, camera, s.area).layers);
        EXPECT_EQ(images[0].channels, images.back().channels) << "way " << images.size() - 1;
    }
}

} // namespace
} // namespace stromboli
