// A render that is stopped, looked at, saved, restored and gone on with.
#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/render_session.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace stromboli {
namespace {

using namespace test;

const std::filesystem::path kScene =
    std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library" / "cornell_mirror_glass.dae";

bool sameBytes(const PixelStatistics& a, const PixelStatistics& b) {
    return a.count == b.count && a.rejected == b.rejected && a.firstRejected == b.firstRejected &&
           std::memcmp(&a.mean, &b.mean, sizeof a.mean) == 0 &&
           std::memcmp(&a.m2, &b.m2, sizeof a.m2) == 0;
}

size_t differences(const Film& a, const Film& b) {
    size_t different = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        different += !sameBytes(a.pixels[i], b.pixels[i]);
    return different;
}

/// Ways to spread samples.
std::vector<std::pair<const char*, Budget>> budgets() {
    return {{"even", {.mostSamplesPerPixel = 40}},
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
    std::unique_ptr<Backend> device(const RenderSettings& s) const {
        // Short dispatches: many places to stop at.
        return std::make_unique<VulkanBackend>(testDevice(), packed_, camera(s), s,
                                               KernelTuning{.lanes = 64, .fixedIterations = 30});
    }
    std::unique_ptr<Backend> reference(const RenderSettings& s) const {
        return std::make_unique<ReferenceBackend>(scene_, camera(s), s, 1);
    }

    using MakeBackend = std::unique_ptr<Backend> (Session::*)(const RenderSettings&) const;

    Film uninterrupted(MakeBackend make, const RenderSettings& s) const {
        const std::unique_ptr<Backend> backend = (this->*make)(s);
        RenderSession session(*backend, s);
        while (session.pass()) {
        }
        return session.film();
    }

    /// Stopped after every `reports` reports of progress, and saved and restored then, on a backend
    /// of its own each time.
    Film inPieces(MakeBackend make, const RenderSettings& s, int reports, int& pieces) const {
        std::unique_ptr<Backend> backend = (this->*make)(s);
        auto session = std::make_unique<RenderSession>(*backend, s);
        for (pieces = 1;; ++pieces) {
            bool stopped = false;
            int left = reports;
            while (session->pass([&](const RenderProgress&) { return !(stopped = --left <= 0); })) {
            }
            if (!stopped) return session->film();
            const std::vector<std::byte> bytes = toBytes(session->save());
            session.reset();
            backend = (this->*make)(s);
            session = std::make_unique<RenderSession>(*backend, sessionFromBytes(bytes));
        }
    }
};

TEST_F(Session, SavedAndRestoredInTheMiddleOfPassesMakesTheSameBytes) {
    for (const auto& [name, budget] : budgets()) {
        const RenderSettings s = settings(budget);
        const Film whole = uninterrupted(&Session::device, s);
        for (const int reports : {40, 100}) {
            int pieces = 0;
            const Film cut = inPieces(&Session::device, s, reports, pieces);
            EXPECT_GT(pieces, reports == 40 ? 1 : 0) << name;
            EXPECT_EQ(differences(whole, cut), 0u) << name << ", " << pieces << " pieces";
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
        EXPECT_EQ(differences(whole, cut), 0u) << name;
    }
}

TEST_F(Session, ThePictureSoFarCanBeLookedAtAfterEveryPass) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 64});
    const std::unique_ptr<Backend> backend = device(s);
    RenderSession session(*backend, s);
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
        RenderSession session(backend, s);
        session.pass();
    }
    const uint64_t pipelines = testDevice().pipelinesMade();
    const uint64_t uploaded = testDevice().bytesUploaded();
    const RenderSettings other = settings({.mostSamplesPerPixel = 4}, 45, 17);
    Camera moved = camera(other);
    moved.position += glm::vec3(0.1f, 0.05f, 0);
    backend.setPicture(moved, other);
    RenderSession session(backend, other);
    while (session.pass()) {
    }
    EXPECT_EQ(testDevice().pipelinesMade(), pipelines);
    const uint64_t sceneBytes = mesh.bvh.records.size() * sizeof mesh.bvh.records[0];
    EXPECT_LT(testDevice().bytesUploaded() - uploaded, sceneBytes / 2);

    const uint64_t uploadedBefore = testDevice().bytesUploaded();
    VulkanBackend fresh(testDevice(), mesh, moved, other);
    EXPECT_EQ(testDevice().pipelinesMade(), pipelines + 1) << "the count does not count";
    EXPECT_GE(testDevice().bytesUploaded() - uploadedBefore, sceneBytes);
    RenderSession again(fresh, other);
    while (again.pass()) {
    }
    EXPECT_EQ(differences(session.film(), again.film()), 0u);
}

/// Where it needs other features of the kernel, it is compiled, and only then.
TEST_F(Session, AnotherEstimatorIsCompiledOnce) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 4});
    VulkanBackend backend(testDevice(), packed_, camera(s), s);
    const uint64_t pipelines = testDevice().pipelinesMade();
    RenderSettings independent = s;
    independent.estimator.sampler = Sampler::Independent;
    for (int i = 0; i < 2; ++i)
        for (const RenderSettings& picture : {independent, s}) {
            backend.setPicture(camera(picture), picture);
            RenderSession session(backend, picture);
            while (session.pass()) {
            }
            EXPECT_EQ(differences(session.film(), uninterrupted(&Session::device, picture)), 0u);
        }
    // One for the other sampler; and one for each of the four sessions to compare with.
    EXPECT_EQ(testDevice().pipelinesMade(), pipelines + 1 + 4);
}

TEST_F(Session, DamagedStatesAreRefused) {
    const RenderSettings s = settings({.mostSamplesPerPixel = 4}, 3, 2);
    const std::unique_ptr<Backend> backend = reference(s);
    RenderSession session(*backend, s);
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
