// Several devices that share a picture: two of the same driver.
#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "host/render/render.hpp"
#include "host/render/team_backend.hpp"
#include "host/vulkan/open_device.hpp"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

/// The kernel of a device that is lost in the middle of its third piece.
class LostDevice final : public Backend {
  public:
    explicit LostDevice(std::shared_ptr<VulkanBackend> inner) : inner_(std::move(inner)) {}

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override {
        const bool isLost = ++pieces_ == 3;
        inner_->sample(isLost ? targets.first((targets.size() + 1) / 2) : targets, film, progress);
        if (isLost) throw DeviceLostError("lost");
    }
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override {
        return inner_->sampleAlone(pixel, sample);
    }
    RenderCounters counters() const override { return inner_->counters(); }
    std::vector<PixelSums> save(const Film& film, PixelRun run) override {
        return inner_->save(film, run);
    }
    void restore(PixelRun run, std::span<const PixelSums> sums, Film& film) override {
        inner_->restore(run, sums, film);
    }

  private:
    std::shared_ptr<VulkanBackend> inner_;
    int pieces_ = 0;
};

class DevicesTogether : public DeviceTest {
  protected:
    Scene scene_ = loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library" /
                             "cornell_mirror_glass.dae");
    GpuScene packed_ = packScene(scene_, buildWideBvh(scene_));
    vulkan::OpenDevice second_ = vulkan::openDevice("");

    static RenderSettings settings() {
        RenderSettings s;
        s.area = {96, 64, {}};
        s.budget = {.mostSamplesPerPixel = kMostSamples, .meanSamplesPerPixel = 24};
        return s;
    }
    std::shared_ptr<VulkanBackend> kernelOn(const vulkan::Device& device, const Camera& camera) {
        return std::make_shared<VulkanBackend>(device, packed_, camera, settings());
    }

    /// The film of one device, and that of two.
    void expectSameBytesWith(bool secondIsLost) {
        const RenderSettings s = settings();
        const Camera camera =
            makeCamera(scene_, CameraChoice::Automatic, s.area.width, s.area.height);
        const auto first = kernelOn(testDevice(), camera);
        const Film alone = render(*first, s);

        const auto a = kernelOn(testDevice(), camera);
        std::shared_ptr<Backend> b = kernelOn(*second_.device, camera);
        if (secondIsLost)
            b = std::make_shared<LostDevice>(std::static_pointer_cast<VulkanBackend>(b));
        TeamBackend team({{"first", a}, {"second", b}}, s.area, [](const std::string&) {});
        expectSameBytes(alone, render(team, s));
        EXPECT_EQ(team.present().size(), secondIsLost ? 1u : 2u);
        EXPECT_GT(b->counters().paths, 0u) << "the second took nothing";
    }
};

TEST_F(DevicesTogether, MakeTheBytesOfOne) {
    expectSameBytesWith(false);
}

TEST_F(DevicesTogether, MakeTheBytesOfOneWhereOneIsLost) {
    expectSameBytesWith(true);
}

} // namespace
} // namespace stromboli
