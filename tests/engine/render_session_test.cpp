// What a session promises, on the reference, which needs no device.
#include "host/core/error.hpp"
#include "tests/engine/engine_fixture.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <future>
#include <unistd.h>

namespace stromboli {
namespace {

using namespace test;

const DeviceRequest kReference{.backend = BackendChoice::Reference};

/// The kind of the error that `action` ends with.
template <class Action>
std::optional<ErrorKind> kindOf(const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        return error.kind();
    }
    return std::nullopt;
}

TEST(RenderSession, PassesMakeThePictureThatARunMakes) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(40);
    RenderSession session(kReference);
    session.begin(scene, request);
    uint32_t passes = 0, before = 0;
    while (session.pass()) {
        const uint32_t samples = session.film().at(3, 4).taken();
        EXPECT_GT(samples, before);
        before = samples;
        ++passes;
    }
    EXPECT_GT(passes, 0u);
    EXPECT_TRUE(session.isOver());
    EXPECT_FALSE(session.pass());
    EXPECT_EQ(session.result().samplesTaken, 40u * 24 * 18);
    EXPECT_TRUE(session.result().complete());
    EXPECT_TRUE(sameBytes(session.film(), alone(kReference, scene, request)));
}

TEST(RenderSession, AMovedCameraHasTheBytesOfASessionOfItsOwn) {
    const auto scene = bundled("cornell_spheres");
    RenderRequest request = smallPicture(16);
    RenderSession session(kReference);
    session.begin(scene, request);
    session.pass();
    session.moveCamera(fromTheSide());
    session.run();
    request.camera = fromTheSide();
    const Film expected = alone(kReference, scene, request);
    EXPECT_TRUE(sameBytes(session.film(), expected));
    request.camera = {};
    EXPECT_FALSE(sameBytes(alone(kReference, scene, request), expected));
}

TEST(RenderSession, ChangedNumbersOfMaterialsHaveTheBytesOfASessionOfItsOwn) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(8);
    RenderSession session(kReference);
    session.begin(scene, request);
    session.pass();
    const auto edited = std::make_shared<Scene>(*scene);
    std::map<uint32_t, Material> numbers;
    for (uint32_t i = 0; i < scene->materials.size(); ++i) {
        edited->materials[i].albedo *= 0.5f;
        numbers[i] = edited->materials[i];
    }
    session.change({.materials = numbers, .lights = {}, .motions = {}});
    session.run();
    EXPECT_TRUE(sameBytes(session.film(), alone(kReference, edited, request)));
    EXPECT_EQ(scene->materials[0].albedo, 2.0f * edited->materials[0].albedo) << "its own stays";
    numbers[0].opacity = 0.5f;
    EXPECT_THROW(session.change({.materials = numbers, .lights = {}, .motions = {}}),
                 std::invalid_argument);
    EXPECT_THROW(session.change({.materials = {{1000, {}}}, .lights = {}, .motions = {}}),
                 std::invalid_argument);
}

TEST(RenderSession, PausesDoNotShowInThePicture) {
    const auto scene = bundled("cornell_spheres");
    RenderRequest request = smallPicture(kMostSamples);
    request.budget.mostPathsPerPixel.reset();
    request.budget.meanPathsPerPixel = 24;
    RenderSession session(kReference);
    session.begin(scene, request);
    int pauses = 0;
    while (session.pass(after(0, Next::Pause)))
        ++pauses;
    EXPECT_GT(pauses, 10);
    EXPECT_TRUE(sameBytes(session.film(), alone(kReference, scene, request)));
}

TEST(RenderSession, CancelledItEndsAndTheNextPictureDoesNotNotice) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(64);
    RenderSession session(kReference);
    session.begin(scene, request);
    const RenderResult result = session.run(after(2, Next::Cancel));
    EXPECT_TRUE(result.cancelled);
    EXPECT_FALSE(result.complete());
    EXPECT_LT(result.samplesTaken, result.samplesAtMost);
    EXPECT_FALSE(session.pass());
    session.begin(scene, request);
    EXPECT_TRUE(session.run().complete());
    EXPECT_TRUE(sameBytes(session.film(), alone(kReference, scene, request)));
}

TEST(RenderSession, AnyThreadMayCancelIt) {
    RenderSession session(kReference);
    session.begin(bundled("cornell_spheres"), smallPicture(kMostSamples)); // for hours
    SessionEvents events;
    std::promise<void> begun;
    bool isFirst = true;
    events.progress = [&](const RenderProgress&) {
        if (std::exchange(isFirst, false)) begun.set_value();
        return Next::GoOn;
    };
    auto cancelled = std::async(std::launch::async, [&] {
        begun.get_future().wait();
        session.cancel();
    });
    EXPECT_TRUE(session.run(events).cancelled);
    cancelled.get();
}

TEST(RenderSession, SavedAfterAnyPauseAnotherOneGoesOnToTheSameBytes) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(40);
    const Film whole = alone(kReference, scene, request);
    for (const int reports : {0, 3, 7}) {
        RenderSession first(kReference);
        first.begin(scene, request);
        ASSERT_TRUE(first.pass(after(reports, Next::Pause)));
        Keeping keeping;
        keeping.begun = first.save();
        RenderSession second(kReference);
        second.begin(scene, request, keeping);
        const RenderResult result = second.run();
        EXPECT_TRUE(sameBytes(second.film(), whole)) << reports;
        EXPECT_EQ(result.samplesTaken, 40u * 24 * 18);
        EXPECT_LT(result.counters.paths, result.samplesTaken) << reports; // some were there
    }
}

TEST(RenderSession, WhatWasSavedOfAnotherPictureIsRefused) {
    const auto scene = bundled("cornell_spheres");
    RenderRequest request = smallPicture(40);
    RenderSession session(kReference);
    session.begin(scene, request);
    ASSERT_TRUE(session.pass());
    Keeping keeping;
    keeping.begun = session.save();
    request.camera = fromTheSide();
    session.begin(scene, request, keeping);
    EXPECT_EQ(kindOf([&] { session.pass(); }), ErrorKind::Usage);
}

TEST(RenderSession, ItsFileIsThereWhenItWasCancelled) {
    const TemporaryFolder folder;
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(40);
    Keeping keeping;
    keeping.file = (folder / "c").string();
    RenderSession session(kReference);
    session.begin(scene, request, keeping);
    EXPECT_EQ(session.run(after(3, Next::Cancel)).checkpoint, keeping.file);
    session.begin(scene, request, takeUp(keeping));
    EXPECT_TRUE(session.run().complete());
    EXPECT_TRUE(sameBytes(session.film(), alone(kReference, scene, request)));
    EXPECT_EQ(folder.size(), 0u); // it is finished
}

/// A film that does not fit the memory is made in bands, which are handed over one by one.
TEST(RenderSession, BandsAreHandedOverAndLeftOut) {
    DeviceRequest small = kReference;
    small.filmMebibytes = 1;
    RenderSession session(small);
    const RenderRequest request = smallPicture(1, {120, 90});
    uint64_t done = 0, leftOut = 0;
    SessionEvents events;
    events.bandDone = [&](const FinishedBand& band) { done += band.film.pixels.size(); };
    events.bandLeftOut = [&](const PictureArea& area) { leftOut += area.pixelCount(); };
    session.begin(bundled("cornell_spheres"), request);
    while (session.pass(events))
        EXPECT_FALSE(session.film().pixels.empty()) << "also when a band has just ended";
    EXPECT_GT(session.result().bands, 1u);
    EXPECT_EQ(done, 120u * 90);
    EXPECT_EQ(leftOut, 0u);
    EXPECT_THROW(session.save(), UsageError);

    done = 0;
    events.progress = [](const RenderProgress&) { return Next::Cancel; };
    session.moveCamera(fromTheSide());
    const RenderResult result = session.run(events);
    EXPECT_EQ(done + leftOut, 120u * 90);
    EXPECT_GT(leftOut, 0u);
    EXPECT_GE(result.pixelsUnreached, leftOut);
}

TEST(RenderSession, PixelsCanBeReadBetweenPasses) {
    RenderRequest request = smallPicture(40);
    request.transparent = true;
    request.layers = {Layer::Normal};
    RenderSession session(kReference);
    session.begin(bundled("cornell_spheres"), request);
    ASSERT_TRUE(session.pass());
    const FloatImage image = session.pixels(true);
    for (const char* name : {"R", "G", "B", "A", "samples", "variance.R", "normal.X"})
        EXPECT_TRUE(image.channels.contains(name)) << name;
    const size_t pixel = 9 * 24 + 12;
    EXPECT_EQ(image.channels.at("samples")[pixel], float(session.film().pixels[pixel].taken()));
    EXPECT_EQ(image.channels.at("R")[pixel], float(session.film().pixels[pixel].mean.r));
    const ByteImage dark = session.shown({}), bright = session.shown({.exposure = 2});
    EXPECT_EQ(dark.alpha.size(), 24u * 18);
    EXPECT_LT(dark.pixel(12, 9)[0], bright.pixel(12, 9)[0]); // without another sample
}

/// A background is behind what surfaces cover, and nowhere else: in all that shows the picture.
TEST(RenderSession, ABackgroundIsWhereNoSurfaceIs) {
    RenderRequest request = smallPicture(8);
    request.transparent = true;
    request.camera = fromTheSide();
    request.camera.from->z += 3; // beside the box there is nothing
    RenderSession session(kReference);
    session.begin(bundled("cornell_spheres"), request);
    session.run();
    const FloatImage clear = session.pixels();
    request.transparent = false;
    // Two texels: the left one red, the right one blue; they meet in the middle of the frame.
    request.background = Background{2, 1, {glm::vec3(4, 0, 0), glm::vec3(0, 0, 2)}};
    session.begin(bundled("cornell_spheres"), request);
    Film written;
    SessionEvents events;
    events.bandDone = [&](const FinishedBand& band) { written = band.film; };
    session.run(events);
    const FloatImage behind = session.pixels();
    EXPECT_FALSE(behind.channels.contains("A"));
    size_t open = 0, covered = 0;
    for (size_t i = 0; i < 24 * 18; ++i) {
        const float alpha = clear.channels.at("A")[i];
        (alpha == 1 ? covered : open) += 1;
        const double right = std::clamp((double(i % 24) + 0.5 - 12) / 18 + 0.5, 0.0, 1.0);
        EXPECT_NEAR(behind.channels.at("R")[i],
                    clear.channels.at("R")[i] + (1 - alpha) * 4 * (1 - right), 1e-5);
        EXPECT_NEAR(behind.channels.at("B")[i], clear.channels.at("B")[i] + (1 - alpha) * 2 * right,
                    1e-5);
        EXPECT_EQ(behind.channels.at("G")[i], clear.channels.at("G")[i]);
        EXPECT_EQ(float(written.pixels[i].mean.b), behind.channels.at("B")[i]);
    }
    EXPECT_GT(open, 20u);
    EXPECT_GT(covered, 20u);
    request.transparent = true;
    EXPECT_THROW(session.begin(bundled("cornell_spheres"), request), UsageError);
}

TEST(RenderSession, ProgressIsThatOfTheWholePicture) {
    DeviceRequest small = kReference;
    small.filmMebibytes = 1; // several bands
    RenderSession session(small);
    session.begin(bundled("cornell_spheres"), smallPicture(2, {120, 90}));
    SessionEvents events;
    RenderProgress last;
    events.progress = [&](const RenderProgress& state) {
        EXPECT_GE(state.share, last.share);
        EXPECT_GE(state.samplesDone, last.samplesDone);
        last = state;
        return Next::GoOn;
    };
    EXPECT_GT(session.run(events).bands, 1u);
    EXPECT_EQ(last.samplesDone, 2u * 120 * 90);
    EXPECT_EQ(last.samplesAtMost, last.samplesDone);
    EXPECT_DOUBLE_EQ(last.share, 1);
    EXPECT_GT(last.counters.rays, last.samplesDone);
}

TEST(RenderSession, ErrorsHaveKinds) {
    const auto scene = bundled("cornell_spheres");
    RenderSession session(kReference);
    RenderRequest outside = smallPicture(1);
    outside.crop = {20, 0, 10, 10};
    EXPECT_EQ(kindOf([&] { session.begin(scene, outside); }), ErrorKind::Usage);
    RenderRequest nobody = smallPicture(1);
    nobody.camera = {CameraChoice::File, "nobody"};
    EXPECT_EQ(kindOf([&] { session.begin(scene, nobody); }), ErrorKind::Scene);
    EXPECT_EQ(kindOf([] { loadScene({"no such file.dae", {}, {}}); }), ErrorKind::Scene);
    EXPECT_FALSE(session.pass()); // nothing was begun
}

TEST(RenderSession, SaysWhatItDoesToItsListenerAlone) {
    Told one, other;
    RenderRequest request = smallPicture(4);
    request.size.reset();
    request.crop = {0, 0, 8, 6};
    const LoadedScene scene = loadScene({"cornell_spheres", {}, {}}, one.listener());
    RenderSession told(kReference, one.listener()), silent(kReference, other.listener());
    told.begin(scene.scene, request);
    told.run();
    EXPECT_EQ(one.count(Stage::Loading), 1u);
    EXPECT_EQ(one.count(Stage::Sampling), 1u);
    EXPECT_TRUE(other.stages.empty());
    EXPECT_TRUE(other.messages.empty());
}

} // namespace
} // namespace stromboli
