// Several devices that share a picture: two of the same driver.
#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "host/render/sampling_session.hpp"
#include "host/render/team_backend.hpp"
#include "host/vulkan/device.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <latch>
#include <memory>
#include <optional>
#include <utility>

namespace stromboli {
namespace {

using namespace test;

/// A device's kernel. Waits before its first piece until both devices have one, and may be lost in
/// the middle of it.
class Shared final : public Backend {
  public:
    Shared(std::shared_ptr<VulkanBackend> inner, bool isFragile, std::shared_ptr<std::latch> both)
        : inner_(std::move(inner)), isFragile_(isFragile), both_(std::move(both)) {}

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override {
        const bool isFirst = std::exchange(takesFirst_, false);
        if (isFirst) both_->arrive_and_wait();
        const bool isLost = isFragile_ && isFirst; // the other may take all pieces after it
        inner_->sample(isLost ? targets.first((targets.size() + 1) / 2) : targets, film, progress);
        if (isLost) throw DeviceLostError("lost");
    }
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override {
        return inner_->sampleAlone(pixel, sample);
    }
    RenderCounters counters() const override { return inner_->counters(); }
    KeptPixels save(const Film& film, PixelRun run) override { return inner_->save(film, run); }
    void restore(PixelRun run, const KeptPixels& pixels, Film& film) override {
        inner_->restore(run, pixels, film);
    }

  private:
    std::shared_ptr<VulkanBackend> inner_;
    bool isFragile_;
    std::shared_ptr<std::latch> both_;
    bool takesFirst_ = true;
};

class DevicesTogether : public DeviceTest {
  protected:
    Scene scene_ = loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library" /
                             "cornell_mirror_glass.dae");
    GpuScene packed_ = packScene(scene_, buildWideBvh(scene_));
    vulkan::OpenDevice second_ = vulkan::openDevice("");
    uint32_t strands_ = 1;

    RenderSettings settings() const {
        RenderSettings s;
        s.strands = strands_;
        s.area = {96, 64, {}};
        s.budget = {.mostSamplesPerPixel = kMostSamples, .meanSamplesPerPixel = 24};
        return s;
    }
    std::shared_ptr<VulkanBackend> kernelOn(const vulkan::Device& device, const Camera& camera) {
        return std::make_shared<VulkanBackend>(device, packed_, camera, settings());
    }

    /// The film of one device, and that of two, of which one may be lost.
    void expectSameBytes(std::optional<size_t> lost) {
        const RenderSettings s = settings();
        const Camera camera =
            makeCamera(scene_, CameraChoice::Automatic, s.area.width, s.area.height);
        const auto single = kernelOn(testDevice(), camera);
        const Film alone = render(*single, s);

        const auto both = std::make_shared<std::latch>(2);
        const auto member = [&](const vulkan::Device& device, size_t number) {
            return std::make_shared<Shared>(kernelOn(device, camera), lost == number, both);
        };
        const std::shared_ptr<Backend> first = member(testDevice(), 0),
                                       second = member(*second_.device, 1);
        TeamBackend team({{"first", first}, {"second", second}}, s.area, [](const std::string&) {});
        test::expectSameBytes(alone, render(team, s));
        EXPECT_EQ(team.present().size(), lost ? 1u : 2u);
        for (const auto& backend : {first, second})
            EXPECT_GT(backend->counters().paths, 0u) << "one took nothing";
    }
};

TEST_F(DevicesTogether, MakeTheBytesOfOne) {
    expectSameBytes({});
}

TEST_F(DevicesTogether, MakeTheBytesOfOneWhereOneIsLost) {
    for (const size_t lost : {0, 1})
        expectSameBytes(lost);
}

TEST_F(DevicesTogether, MakeTheBytesOfOneWherePixelsHaveStrands) {
    strands_ = 4;
    expectSameBytes({});
    expectSameBytes(1);
}

} // namespace
} // namespace stromboli
