#include "tests/render/device_render.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/cs184/cs184.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/collada/load_collada.hpp"
#include "source_dir.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli::test {

Film renderOnDevice(const vulkan::Device& device, const Scene& scene, const Camera& camera,
                    const RenderSettings& settings, const KernelTuning& tuning) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    VulkanBackend backend(device, gpu, camera, settings, tuning);
    return render(backend, settings);
}

bool sameStatistics(const Film& a, const Film& b) {
    return std::equal(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), b.pixels.end(),
                      [](const PixelStatistics& p, const PixelStatistics& q) {
                          return p.count == q.count && p.mean == q.mean && p.m2 == q.m2;
                      });
}

void expectTheSameBytesHoweverTheWorkIsCut(
    const std::function<Film(const KernelTuning&)>& pictureWith) {
    const Film whole = pictureWith({});
    EXPECT_TRUE(
        sameStatistics(whole, pictureWith({.scheduler = PathScheduler::Wavefront, .lanes = 100})))
        << "the other scheduler";
    EXPECT_TRUE(sameStatistics(whole, pictureWith({.fixedIterations = 3})))
        << "in short dispatches";
    EXPECT_TRUE(sameStatistics(whole, pictureWith({.texelFetch = false})))
        << "from storage buffers";
}

Scene loadScene(const std::filesystem::path& file, const SceneConventions& conventions) {
    return loadCollada(file, conventions);
}

SceneConventions readingOf(const Estimator& estimator) {
    return estimator.conventions == cs184Shading() ? cs184Conventions() : SceneConventions{};
}

FramingConventions framingOf(const Estimator& estimator) {
    return estimator.conventions == cs184Shading() ? cs184Framing() : FramingConventions{};
}

std::filesystem::path sharedFolder() {
    return std::filesystem::path(STROMBOLI_SOURCE_DIR) / ".." / "shared";
}

std::vector<std::filesystem::path> allScenes() {
    std::vector<std::filesystem::path> files;
    for (const auto& folder :
         {std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library",
          sharedFolder() / "scenes" / "sky", sharedFolder() / "scenes" / "meshedit"}) {
        if (!std::filesystem::is_directory(folder)) continue;
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".dae") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace stromboli::test
