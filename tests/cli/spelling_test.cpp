// Numbers, units and sizes as they are written, and words that may be missing.
#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "tests/cli/parse.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using test::parse;

TEST(Spelling, NumbersHaveExponentsAndUnits) {
    EXPECT_EQ(
        parse({"render", "a.dae", "-o", "a.png", "-s", "2.5k"}).picture.budget.meanPathsPerPixel,
        2500u);
    EXPECT_EQ(
        parse({"render", "a.dae", "-o", "a.png", "-s", "1e6"}).picture.budget.meanPathsPerPixel,
        1'000'000u);
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "--time", "1k"}).picture.budget.stop.seconds,
              1000);
    EXPECT_EQ(parse<BenchOptions>({"bench", "--sizes", "1k,2.5M"}).settings.sizes,
              (std::vector<uint64_t>{1000, 2'500'000}));
}

TEST(Spelling, QuantitiesHaveUnits) {
    const auto with = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"render", "a.dae", "-o", "a.png"});
        return parse(std::move(words));
    };
    for (const auto& [word, seconds] : {std::pair("10s", 10.0),
                                        {"2m", 120.0},
                                        {"1.5min", 90.0},
                                        {"1h30m", 5400.0},
                                        {"250ms", 0.25},
                                        {"1e2s", 100.0}})
        EXPECT_EQ(with({"--time", word}).picture.budget.stop.seconds, seconds) << word;
    for (const char* word : {"2048", "2G", "2GiB", "2048M", "1G1024MiB"})
        EXPECT_EQ(with({"--max-memory", word}).device.mostMebibytes, 2048) << word;
    EXPECT_DOUBLE_EQ(with({"--noise", "2%"}).picture.budget.stop.noise, 0.02);
    EXPECT_DOUBLE_EQ(*with({"--fov", "90deg"}).picture.camera.fieldOfView, std::acos(0.0));
    EXPECT_DOUBLE_EQ(*with({"--fov", "90°"}).picture.camera.fieldOfView, std::acos(0.0));
    EXPECT_DOUBLE_EQ(*with({"--fov", "1rad"}).picture.camera.fieldOfView, 1);
    EXPECT_DOUBLE_EQ(
        with({"--focus", "2m50cm", "--aperture", "5mm"}).picture.camera.focus->distance, 2.5);
}

TEST(Spelling, QuantitiesAreNoOthers) {
    for (const char* word : {"", "s", "10q", "30m1h", "1h1h", "10 s", "10s ", "1h-5m", "s10", "%"})
        EXPECT_EQ(quantityIn(word, kTimes), std::nullopt) << word;
    EXPECT_EQ(quantityIn("2%", kTimes), std::nullopt);
    EXPECT_EQ(quantityIn("-5deg", kDegrees), -5);
}

TEST(Spelling, SizesMayBeOneWord) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"-r", "640", "360"},
                                                  {"-r", "640x360"},
                                                  {"-r", "640X360"},
                                                  {"--size=640x360"},
                                                  {"--size", "640x360"}}) {
        std::vector<std::string> all = {"render", "a.dae", "-o", "a.png"};
        all.insert(all.end(), words.begin(), words.end());
        const RenderOptions o = parse(all);
        EXPECT_EQ(o.picture.size->width, 640u);
        EXPECT_EQ(o.picture.size->height, 360u);
        EXPECT_EQ(o.command.back(), "-r 640 360"); // however it was written
    }
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "-r", "640"}), UsageError);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "-r", "640x"}), UsageError);
    EXPECT_EQ(parse({"render", "4x4", "-o", "a.png"}).scene.source, "4x4");
}

TEST(Spelling, WatchNeedsNoPort) {
    const auto portOf = [](std::vector<std::string> words) {
        words.insert(words.begin(), "render");
        const RenderOptions o = parse(words);
        EXPECT_EQ(o.scene.source, "a.dae");
        EXPECT_EQ(o.output.file, "a.png");
        return o.watch.port;
    };
    EXPECT_EQ(portOf({"a.dae", "-o", "a.png"}), std::nullopt);
    EXPECT_EQ(portOf({"a.dae", "-o", "a.png", "--watch"}), 0u);
    EXPECT_EQ(portOf({"--watch", "a.dae", "-o", "a.png"}), 0u);
    EXPECT_EQ(portOf({"--watch", "-o", "a.png", "a.dae"}), 0u);
    EXPECT_EQ(portOf({"-o", "a.png", "--watch", "-r", "8", "9", "a.dae"}), 0u);
    EXPECT_EQ(portOf({"--watch", "8080", "a.dae", "-o", "a.png"}), 8080u);
    EXPECT_EQ(portOf({"--watch=8080", "a.dae", "-o", "a.png"}), 8080u);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "--watch", "65536"}), UsageError);
}

TEST(Spelling, DenoiserAndGroundNeedNoWord) {
    const auto parsed = [](std::vector<std::string> words) {
        words.insert(words.begin(), "render");
        RenderOptions o = parse(words);
        EXPECT_EQ(o.scene.source, "a.dae");
        EXPECT_EQ(o.output.file, "a.png");
        return o;
    };
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"a.dae", "-o", "a.png", "--denoise", "--ground"},
          {"--denoise", "a.dae", "--ground", "-o", "a.png"},
          {"--ground", "a.dae", "--denoise", "--exposure", "auto", "-o", "a.png"},
          {"a.dae", "-o", "a.png", "--denoise", "on", "--ground", "on"}}) {
        const RenderOptions o = parsed(words);
        EXPECT_EQ(o.picture.denoiser, Denoiser::On);
        EXPECT_TRUE(o.scene.ground.isGiven);
        EXPECT_EQ(o.scene.ground.color, glm::vec3(0.5f));
    }
    EXPECT_EQ(parsed({"--denoise", "oidn", "a.dae", "-o", "a.png"}).picture.denoiser,
              Denoiser::Oidn);
    EXPECT_EQ(parsed({"--ground", "0.2,0.3,.4", "a.dae", "-o", "a.png"}).scene.ground.color,
              glm::vec3(0.2f, 0.3f, 0.4f));
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "--denoise", "oidm"}), UsageError)
        << "a word that is nearly one of its own";
}

TEST(Spelling, PortalsAreObjectsAndMayBeLeftOut) {
    const auto parsed = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"render", "a.dae", "-o", "a.png"});
        return parse(words);
    };
    EXPECT_TRUE(parsed({}).scene.portals.empty());
    EXPECT_EQ(parsed({}).picture.portals, PortalUse::Automatic);
    EXPECT_EQ(parsed({"--portals", "off"}).picture.portals, PortalUse::Off);
    const std::vector<std::string> both = {"left", "right"};
    EXPECT_EQ(parsed({"--portal", "left,right"}).scene.portals, both);
    EXPECT_EQ(parsed({"--portal", "left", "--portal", "right"}).scene.portals, both);
}

} // namespace
} // namespace stromboli
