// Checkpoints as files: what comes back, what is refused and why.
#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/error.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <random>

namespace stromboli {
namespace {

using test::refusalOf;

using testing::HasSubstr;

Checkpoint example() {
    Checkpoint c;
    c.identity = {"0.1.0", "12345678", "room.dae", 42, "vulkan", "a device"};
    c.state.settings.area = {30, 20, {1, 2, 3, 4}};
    c.state.settings.estimator.seed = 7;
    c.state.settings.budget.mostSamplesPerPixel = 99;
    for (uint32_t i = 0; i < 12; ++i)
        c.state.pixels.append({.count = i, .mean = {1, 2, i}});
    c.state.pending = {{3, 17}};
    c.state.secondsUsed = 12.5;
    return c;
}

std::string contentOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(CheckpointFile, ComesBackAsItWas) {
    const TemporaryFolder folder;
    const Checkpoint c = example();
    writeCheckpoint(folder / "a", c);
    const Checkpoint back = readCheckpoint(folder / "a");
    EXPECT_EQ(back.identity.program, c.identity.program);
    EXPECT_EQ(back.identity.code, c.identity.code);
    EXPECT_EQ(back.identity.scene, c.identity.scene);
    EXPECT_EQ(back.identity.sceneSum, c.identity.sceneSum);
    EXPECT_EQ(back.identity.backend, c.identity.backend);
    EXPECT_EQ(back.identity.device, c.identity.device);
    EXPECT_EQ(toBytes(back.state), toBytes(c.state));
    EXPECT_EQ(folder.size(), 1u);
}

/// What a session of the kernel keeps, with what changes little from pixel to pixel: counts, and
/// numbers whose exponents are much alike.
TEST(CheckpointFile, IsSmall) {
    const TemporaryFolder folder;
    Checkpoint c = example();
    c.state.settings.area = {100, 100, {}};
    std::mt19937 random(1);
    std::uniform_real_distribution<float> value(0, 1);
    c.state.pixels = {KeptPixels::As::States, 1, {}};
    for (int i = 0; i < 10'000; ++i) {
        gpu::PixelState s{};
        s.count = 64;
        for (glm::vec3* v : {&s.sum, &s.sumError, &s.m2, &s.m2Error})
            *v = {value(random), value(random), value(random)};
        c.state.pixels.append(std::span(&s, 1));
    }
    writeCheckpoint(folder / "a", c);
    EXPECT_LT(std::filesystem::file_size(folder / "a"), 0.75 * double(toBytes(c.state).size()));
    EXPECT_EQ(toBytes(readCheckpoint(folder / "a").state), toBytes(c.state));
}

TEST(CheckpointFile, DamageIsSeen) {
    const TemporaryFolder folder;
    const Checkpoint c = example();
    writeCheckpoint(folder / "a", c);
    const std::string whole = contentOf(folder / "a");
    for (size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = char(damaged[i] ^ 0x10);
        std::ofstream(folder / "b", std::ios::binary) << damaged;
        const std::string why = refusalOf([&] { readCheckpoint(folder / "b"); });
        ASSERT_THAT(why, HasSubstr("/b: ")) << "byte " << i;
    }
}

TEST(CheckpointFile, PartsOfAFileAreRefused) {
    const TemporaryFolder folder;
    writeCheckpoint(folder / "a", example());
    const std::string whole = contentOf(folder / "a");
    for (size_t size = 0; size < whole.size(); size += 7) {
        std::ofstream(folder / "b", std::ios::binary) << whole.substr(0, size);
        EXPECT_NE(refusalOf([&] { readCheckpoint(folder / "b"); }), "") << size;
    }
    EXPECT_THAT(refusalOf([&] { readCheckpoint(folder / "none"); }), HasSubstr("cannot read"));
    EXPECT_THAT(refusalOf([&] { readCheckpoint(folder.path()); }), HasSubstr("cannot read"));
}

TEST(CheckpointFile, SaysWhatDiffers) {
    const Checkpoint c = example();
    const auto refusal = [&](const std::function<void(RenderIdentity&, RenderSettings&)>& change) {
        RenderIdentity identity = c.identity;
        RenderSettings settings = c.state.settings;
        change(identity, settings);
        return refusalOf([&] { requireSameRender("a", c, identity, settings); });
    };
    EXPECT_EQ(refusal([](auto&, auto&) {}), "");
    EXPECT_EQ(refusal([](auto&, auto& s) { s.budget.mostSamplesPerPixel = 1000; }), "");
    EXPECT_EQ(refusal([](auto& i, auto&) { i.scene = "moved.dae"; }), "");
    EXPECT_EQ(refusal([](auto& i, auto&) { i.device = "another"; }), "");
    EXPECT_EQ(refusal([](auto& i, auto&) { i.program = "0.2.0"; }),
              ""); // only its documents differ
    EXPECT_THAT(
        refusal([](auto& i, auto&) { i.program = "0.2.0", i.code = "0"; }),
        HasSubstr("another build of the program, 0.1.0, which takes other samples than 0.2.0"));
    EXPECT_THAT(refusal([](auto& i, auto&) { i.sceneSum = 43; }),
                HasSubstr("the file has changed"));
    EXPECT_THAT(refusal([](auto& i, auto&) { i.sceneSum = 43, i.scene = "b.dae"; }),
                HasSubstr("(room.dae)"));
    EXPECT_THAT(refusal([](auto& i, auto&) { i.backend = "reference"; }),
                HasSubstr("the backend vulkan; name it with --backend"));
    EXPECT_THAT(refusal([](auto&, auto& s) { s.area.width = 31; }),
                HasSubstr("30 x 20 pixels, 12 of them rendered"));
    EXPECT_THAT(refusal([](auto&, auto& s) { s.area.crop.x = 2; }), HasSubstr("--crop"));
    EXPECT_THAT(refusal([](auto&, auto& s) { s.estimator.seed = 8; }), HasSubstr("other settings"));
    EXPECT_THAT(refusal([](auto&, auto& s) { s.estimator.branches = 2; }),
                HasSubstr("other settings"));
}

TEST(CheckpointFile, APassIsOfTheBudgetItWasPlannedFor) {
    const SessionState state = example().state;
    EXPECT_EQ(withBudget(state, state.settings.budget).pending.size(), 1u);
    Budget more = state.settings.budget;
    more.mostSamplesPerPixel *= 2;
    EXPECT_TRUE(withBudget(state, more).pending.empty());
    EXPECT_EQ(withBudget(state, more).settings.budget, more);
    more = state.settings.budget;
    more.stop.seconds = 5;
    EXPECT_TRUE(withBudget(state, more).pending.empty());
}

} // namespace
} // namespace stromboli
