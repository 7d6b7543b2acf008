// A render that is stopped, looked at, saved, restored and gone on with.
#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

const std::filesystem::path kScene =
    std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library" / "cornell_mirror_glass.dae";

/// Ways to spread samples.
std::vector<std::pair<const char*, Budget>> budgets() {
    return {{"even", {.mostSamplesPerPixel = 40}},
            {"in blocks", {.mostSamplesPerPixel = 40, .samplesPerBlock = 7}},
            {"by noise", {.mostSamplesPerPixel = kMostSamples, .meanSamplesPerPixel = 24}},
            {"adaptive",
             {.mostSamplesPerPixel = 200,
              .adaptive = {.enabled = true, .batch = 16, .tolerance = 0.2}}}};
}

class Session : public DeviceTest {
  public: // so that tests may name its members
    Scene scene_ = loadScene(kScene);
    GpuScene packed_ = packScene(scene_, buildWideBvh(scene_));

    static RenderSettings settings(const Budget& budget, uint32_t width = 32,
                                   uint32_t height = 24) {
        RenderSettings s;
        s.area = {width, height, {}};
        s.estimator.maxBounces = 4;
        s.budget = budget;
        return s;
    }
    Camera camera(const RenderSettings& s) const {
        return makeCamera(scene_, CameraChoice::Automatic, s.area.width, s.area.height);
    }
    static std::unique_ptr<Backend> inBlocks(std::unique_ptr<Backend> backend,
                                             const RenderSettings& s) {
        if (!s.budget.isInBlocks()) return backend;
        return std::make_unique<BlockBackend>(std::move(backend), s.area, s.budget.samplesPerBlock);
    }
    std::unique_ptr<Backend> device(const RenderSettings& s) const {
        // Short dispatches: many places to stop at.
        return inBlocks(
            std::make_unique<VulkanBackend>(testDevice(), packed_, camera(s), s,
                                            KernelTuning{.lanes = 64, .fixedIterations = 30}),
            s);
    }
    std::unique_ptr<Backend> reference(const RenderSettings& s) const {
        return inBlocks(std::make_unique<ReferenceBackend>(scene_, camera(s), s, 1), s);
    }

    using MakeBackend = std::unique_ptr<Backend> (Session::*)(const RenderSettings&) const;

    Film uninterrupted(MakeBackend make, const RenderSettings& s) const {
        const std::unique_ptr<Backend> backend = (this->*make)(s);
        SamplingSession session(*backend, s);
        while (session.pass()) {
        }
        return session.film();
    }

    /// Stopped after every `reports` reports of progress, and saved and restored then, on a backend
    /// of its own each time.
    Film inPieces(MakeBackend make, const RenderSettings& s, int reports, int& pieces) const {
        std::unique_ptr<Backend> backend = (this->*make)(s);
        auto session = std::make_unique<SamplingSession>(*backend, s);
        for (pieces = 1;; ++pieces) {
            bool stopped = false;
            int left = reports;
            while (session->pass([&](const RenderProgress&) { return !(stopped = --left <= 0); })) {
            }
            if (!stopped) return session->film();
            const std::vector<std::byte> bytes = toBytes(session->save());
            session.reset();
            backend = (this->*make)(s);
            session = std::make_unique<SamplingSession>(*backend, sessionFromBytes(bytes));
        }
    }
};

TEST_F(Session, SavedAndRestoredInTheMiddleOfPassesMakesTheSameBytes) {
    for (const uint32_t strands : {1u, 4u})
        for (const auto& [name, budget] : budgets()) {
            RenderSettings s = settings(budget);
            s.strands = strands;
            const Film whole = uninterrupted(&Session::device, s);
            for (const int reports : {40, 100}) {
                int pieces = 0;
                const Film cut = inPieces(&Session::device, s, reports, pieces);
                EXPECT_GT(pieces, reports == 40 ? 1 : 0) << name;
                EXPECT_EQ(differingPixels(whole, cut), 0u) << name << ", " << pieces << " pieces";
            }
        }
}

TEST_F(Session, TheReferenceGoesOnAsWell) {
    for (const auto& [name, budget] : budgets()) {
        const RenderSettings s = settings(budget, 12, 9);
        const Film whole = uninterrupted(&Session::reference, s);
        int pieces = 0;
        const Film cut = inPieces(&Session::reference, s, 1, pieces);
        EXPECT_GT(pieces, 1) << name;
        EXPECT_EQ(differingPixels(whole, cut), 0u) << name;
    }
}

/// Samples of blocks are those of a render without blocks, and so are their sums but for rounding:
/// the sum and the sums of squares of a float each, compensated, to 2^-40 or so.
TEST_F(Session, BlocksHoldTheSameSamples) {
    for (const MakeBackend make : {&Session::device, &Session::reference}) {
        const Film plain = uninterrupted(make, settings({.mostSamplesPerPixel = 40}, 12, 9));
        const Film blocks =
            uninterrupted(make, settings({.mostSamplesPerPixel = 40, .samplesPerBlock = 7}, 12, 9));
        for (size_t i = 0; i < plain.pixels.size(); ++i) {
            const PixelStatistics &p = plain.pixels[i], &q = blocks.pixels[i];
            EXPECT_EQ(p.taken(), q.taken());
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(p.mean[c], q.mean[c], 1e-11 * p.mean[c]);
                EXPECT_NEAR(p.m2[c], q.m2[c], 1e-6 * p.m2[c]);
            }
        }
    }
}

/// As long as there is only one block, nothing is added up.
TEST_F(Session, ASingleBlockHasTheBytesOfNone) {
    const Film plain = uninterrupted(&Session::device, settings({.mostSamplesPerPixel = 32}));
    const Film block = uninterrupted(&Session::device,
                                     settings({.mostSamplesPerPixel = 32, .samplesPerBlock = 64}));
    EXPECT_EQ(differingPixels(plain, block), 0u);
}

/// Each block by a backend of its own, in any order, whatever the device's work is cut into.
TEST_F(Session, BlocksOfSeveralBackendsAddUpToOneRender) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 40, .samplesPerBlock = 16}, 12, 9);
    const SampleBlocks blocks{40, 16};
    for (const bool onDevice : {true, false}) {
        std::vector<ExactStatistics> sum(s.area.pixelCount());
        for (const uint32_t block : {2u, 0u, 1u}) {
            std::unique_ptr<Backend> backend;
            if (onDevice)
                backend = std::make_unique<VulkanBackend>(testDevice(), packed_, camera(s), s,
                                                          KernelTuning{.lanes = 30 + 50 * block});
            else
                backend = std::make_unique<ReferenceBackend>(scene_, camera(s), s, 2);
            const uint32_t first = blocks.firstOf(block);
            std::vector<PixelTarget> targets;
            for (uint32_t i = 0; i < sum.size(); ++i)
                targets.push_back({i, blocks.firstOf(block + 1) - first});
            Film film(s.area);
            backend->beginAt(first);
            backend->sample(targets, film, {});
            BlockSums one;
            one.add(film, first);
            for (size_t i = 0; i < sum.size(); ++i)
                sum[i].add(one.pixels()[i]);
        }
        const Film whole = uninterrupted(onDevice ? &Session::device : &Session::reference, s);
        for (size_t i = 0; i < sum.size(); ++i)
            EXPECT_TRUE(sameBytes(sum[i].statistics(), whole.pixels[i])) << i;
    }
}

TEST_F(Session, ThePictureSoFarCanBeLookedAtAfterEveryPass) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 64});
    const std::unique_ptr<Backend> backend = device(s);
    SamplingSession session(*backend, s);
    uint64_t before = 0;
    while (session.pass()) {
        uint64_t taken = 0;
        for (const PixelStatistics& p : session.film().pixels)
            taken += p.taken();
        EXPECT_GT(taken, before);
        EXPECT_EQ(taken, session.samplesDone());
        EXPECT_GT(session.outcome().noise.estimate, 0);
        before = taken;
    }
    EXPECT_EQ(before, 64u * 32 * 24);
}

/// Not one byte of the scene, nor a compilation.
TEST_F(Session, AnotherPictureOfTheSceneNeitherCompilesNorUploadsIt) {
    const Scene scene = loadScene(kScene.parent_path() / "cornell_mesh.dae"); // some megabytes
    const GpuScene mesh = packScene(scene, buildWideBvh(scene));
    const RenderSettings s = settings({.mostSamplesPerPixel = 4});
    VulkanBackend backend(testDevice(), mesh, camera(s), s);
    { // something is there to be left over
        SamplingSession session(backend, s);
        session.pass();
    }
    const uint64_t pipelines = testDevice().pipelinesMade();
    const uint64_t uploaded = testDevice().bytesUploaded();
    const RenderSettings other = settings({.mostSamplesPerPixel = 4}, 45, 17);
    Camera moved = camera(other);
    moved.position += glm::vec3(0.1f, 0.05f, 0);
    backend.setPicture(moved, other);
    SamplingSession session(backend, other);
    while (session.pass()) {
    }
    EXPECT_EQ(testDevice().pipelinesMade(), pipelines);
    const uint64_t sceneBytes = mesh.bvh.records.size() * sizeof mesh.bvh.records[0];
    EXPECT_LT(testDevice().bytesUploaded() - uploaded, sceneBytes / 2);

    const uint64_t uploadedBefore = testDevice().bytesUploaded();
    VulkanBackend fresh(testDevice(), mesh, moved, other);
    EXPECT_EQ(testDevice().pipelinesMade(), pipelines) << "the same kernel was compiled twice";
    EXPECT_GE(testDevice().bytesUploaded() - uploadedBefore, sceneBytes);
    SamplingSession again(fresh, other);
    while (again.pass()) {
    }
    EXPECT_EQ(differingPixels(session.film(), again.film()), 0u);
}

/// Where it needs other features of the kernel, it is compiled, and only then.
TEST_F(Session, AnotherEstimatorIsCompiledOnce) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 4});
    testDevice().keptPipelines().clear(); // of other tests
    VulkanBackend backend(testDevice(), packed_, camera(s), s);
    const uint64_t pipelines = testDevice().pipelinesMade();
    RenderSettings independent = s;
    independent.estimator.sampler = Sampler::Independent;
    for (int i = 0; i < 2; ++i)
        for (const RenderSettings& picture : {independent, s}) {
            backend.setPicture(camera(picture), picture);
            SamplingSession session(backend, picture);
            while (session.pass()) {
            }
            EXPECT_EQ(differingPixels(session.film(), uninterrupted(&Session::device, picture)),
                      0u);
        }
    // One for the other sampler, which the sessions to compare with share.
    EXPECT_EQ(testDevice().pipelinesMade(), pipelines + 1);
}

/// Its checksum is right, as that of a file that somebody made.
TEST_F(Session, PixelsOfNoKnownKindAreRefused) {
    SessionState state;
    state.pixels.empty(3);
    EXPECT_EQ(sessionFromBytes(toBytes(state)).pixels.count(), 3u);
    const auto isRefused = [&](const auto& damage) {
        SessionState damaged = state;
        damage(damaged.pixels);
        EXPECT_THROW(sessionFromBytes(toBytes(damaged)), UsageError);
    };
    isRefused([](KeptPixels& p) { p.strands = 0, p.as = KeptPixels::As::States; });
    isRefused([](KeptPixels& p) { p.strands = 5, p.as = KeptPixels::As::States; });
    isRefused([](KeptPixels& p) { p.as = KeptPixels::As(7); });
    isRefused([](KeptPixels& p) { p.bytes.pop_back(); });
}

TEST_F(Session, DamagedStatesAreRefused) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 4}, 3, 2);
    const std::unique_ptr<Backend> backend = reference(s);
    SamplingSession session(*backend, s);
    session.pass();
    const std::vector<std::byte> bytes = toBytes(session.save());
    EXPECT_EQ(toBytes(sessionFromBytes(bytes)), bytes);
    for (size_t size : {size_t(0), size_t(10), bytes.size() / 2, bytes.size() - 1})
        EXPECT_THROW(sessionFromBytes(std::span(bytes).first(size)), UsageError) << size;
    for (size_t at = 0; at < bytes.size(); at += 7) {
        std::vector<std::byte> damaged = bytes;
        damaged[at] ^= std::byte(1);
        EXPECT_THROW(sessionFromBytes(damaged), UsageError) << at;
    }
}

} // namespace
} // namespace stromboli
