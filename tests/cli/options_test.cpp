// What the command line means.
#include "host/cli/cs184_spelling.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

Options parse(std::vector<std::string> arguments) {
    const std::optional<Options> options = parseOptions(std::move(arguments));
    if (!options) throw std::runtime_error("nothing to run");
    return *options;
}

TEST(Options, Defaults) {
    const Options o = parse({"render", "a.dae", "-o", "a.png"});
    EXPECT_EQ(o.command, Command::Render);
    EXPECT_EQ(o.scene, "a.dae");
    EXPECT_EQ(o.output, "a.png");
    EXPECT_EQ(o.settings.stop.meanSamples, 64u);
    EXPECT_EQ(o.settings.maxBounces, 8u);
    EXPECT_FALSE(o.settings.adaptive.enabled);
    EXPECT_EQ(o.settings.roulette.mode, Roulette::Mode::Throughput);
    EXPECT_FALSE(o.sizeGiven);
}

TEST(Options, EverythingGiven) {
    const Options o =
        parse({"render", "a.dae",      "-o",   "a.exr",     "-s",        "9",
               "-l",     "3",          "-m",   "4",         "-r",        "20",
               "10",     "-a",         "8",    "0.1",       "-H",        "--min-bounce",
               "2",      "--roulette", "0.25", "--camera",  "frame",     "--seed",
               "5",      "--device",   "cpu",  "--backend", "reference", "--exposure",
               "-1.5",   "--crop",     "1",    "2",         "3",         "4",
               "-q"});
    EXPECT_EQ(o.settings.samplesPerPixel, 9u);
    EXPECT_EQ(o.settings.lightSamples, 3u);
    EXPECT_EQ(o.settings.maxBounces, 4u);
    EXPECT_EQ(o.settings.width, 20u);
    EXPECT_EQ(o.settings.height, 10u);
    EXPECT_TRUE(o.settings.adaptive.enabled);
    EXPECT_EQ(o.settings.adaptive.batch, 8u);
    EXPECT_EQ(o.settings.adaptive.tolerance, 0.1);
    EXPECT_EQ(o.settings.directLight, DirectLight::Hemisphere);
    EXPECT_EQ(o.settings.minBounce, 2u);
    EXPECT_EQ(o.settings.roulette.mode, Roulette::Mode::Fixed);
    EXPECT_EQ(o.settings.roulette.terminationProbability, 0.25);
    EXPECT_EQ(o.camera, CameraChoice::Frame);
    EXPECT_EQ(o.settings.seed, 5u);
    EXPECT_EQ(o.device, "cpu");
    EXPECT_EQ(o.backend, BackendChoice::Reference);
    EXPECT_EQ(o.exposure, -1.5);
    EXPECT_EQ(o.settings.crop.height, 4u);
    EXPECT_EQ(o.verbosity, Verbosity::Quiet);
}

TEST(Options, Samplers) {
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png"}).settings.sampler, Sampler::Sobol);
    EXPECT_EQ(parse({"check", "a.dae", "--sampler", "independent"}).settings.sampler,
              Sampler::Independent);
    // That renderer's samples are independent; its adaptive rule counts on it.
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "--cs184"}).settings.sampler,
              Sampler::Independent);
    EXPECT_EQ(parse({"info", "a.dae", "--cs184", "--sampler", "sobol"}).settings.sampler,
              Sampler::Sobol);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "--sampler", "halton"}), UsageError);
}

TEST(Options, StopRules) {
    const Options noise = parse({"render", "a.dae", "-o", "a.png", "--noise", "0.02"});
    EXPECT_EQ(noise.settings.stop.noise, 0.02);
    EXPECT_GT(noise.settings.samplesPerPixel, 1000000u); // no limit but the noise
    const Options both = parse({"render", "a.dae", "-o", "a.png", "--cs184", "--noise", "0.02",
                                "--time", "10", "-s", "500"});
    EXPECT_EQ(both.settings.stop.seconds, 10);
    EXPECT_EQ(both.settings.samplesPerPixel, 500u);
    EXPECT_FALSE(both.settings.adaptive.enabled);
}

TEST(Options, SamplesAreSpreadUnlessSomethingElseIsAsked) {
    const RenderSettings spread = parse({"render", "a.dae", "-o", "a.png", "-s", "40"}).settings;
    EXPECT_EQ(spread.stop.meanSamples, 40u);
    EXPECT_GT(spread.samplesPerPixel, 40u);
    for (const std::vector<std::string>& evenly : {std::vector<std::string>{"--even"},
                                                   {"--cs184", "--even"},
                                                   {"-s", "8"},
                                                   {"--cs184"},
                                                   {"-a", "32", "0.1"}}) {
        std::vector<std::string> words = {"render", "a.dae", "-o", "a.png"};
        words.insert(words.end(), evenly.begin(), evenly.end());
        const RenderSettings s = parse(words).settings;
        EXPECT_FALSE(s.stop.spreads()) << evenly[0];
        EXPECT_LE(s.samplesPerPixel, 64u) << evenly[0];
        EXPECT_EQ(s.adaptive.enabled, evenly[0] == "-a" || words.back() == "--cs184");
    }
    for (const std::vector<std::string>& both :
         {std::vector<std::string>{"-a", "32", "0.1"}, {"--noise", "0.1"}, {"--time", "1"}}) {
        std::vector<std::string> words = {"render", "a.dae", "-o", "a.png", "--even"};
        words.insert(words.end(), both.begin(), both.end());
        EXPECT_THROW(parse(words), UsageError) << both[0];
    }
    EXPECT_FALSE(parse({"check", "a.dae", "-s", "64"}).settings.stop.spreads());
}

TEST(Options, Cs184ChangesDefaults) {
    const Options o = parse({"render", "a.dae", "-o", "a.png", "--cs184"});
    EXPECT_EQ(o.settings.samplesPerPixel, 1u);
    EXPECT_EQ(o.settings.maxBounces, 1u);
    EXPECT_TRUE(o.settings.adaptive.enabled);
    EXPECT_EQ(o.settings.adaptive.batch, 32u);
    EXPECT_EQ(o.settings.roulette.mode, Roulette::Mode::None);
}

TEST(Options, Cs184Spellings) {
    const Options o =
        parse({"render", "-t",  "4",  "-s", "2",  "-m", "3",  "-o", "0",     "-r",
               "480",    "360", "-p", "10", "20", "30", "40", "-f", "a.png", "a.dae"});
    EXPECT_EQ(o.output, "a.png");
    EXPECT_EQ(o.settings.minBounce, 3u); // -o 0: only the light of exactly m bounces
    EXPECT_EQ(o.threads, 4u);
    EXPECT_EQ(o.settings.crop.x, 10u);
    EXPECT_EQ(o.settings.crop.y, 360u - 20 - 40); // Y counts from the bottom
    EXPECT_EQ(parse({"render", "a.dae", "-f", "a.png", "-o", "1", "-m", "3"}).settings.minBounce,
              0u);
}

TEST(Options, SceneMayFollowAnOptionWithSeveralValues) {
    EXPECT_EQ(parse({"render", "-o", "a.png", "-r", "8", "9", "a.dae"}).scene, "a.dae");
    EXPECT_EQ(parse({"render", "-o", "a.png", "-a", "8", "0.1", "a.dae"}).scene, "a.dae");
    EXPECT_EQ(parse({"render", "-o", "a.png", "--crop", "0", "0", "8", "9", "a.dae"}).scene,
              "a.dae");
}

TEST(Options, SpellingLeavesOutputsAlone) {
    EXPECT_EQ(fromCs184Spelling({"-o", "0.png"}), (std::vector<std::string>{"-o", "0.png"}));
    EXPECT_EQ(fromCs184Spelling({"-o", "0"}), (std::vector<std::string>{"--accumulate", "0"}));
}

TEST(Options, ContradictionsAreRefused) {
    for (const std::vector<std::string>& extra : std::vector<std::vector<std::string>>{
             {"-s", "0"},           {"-s", "99999999999"},
             {"-s", "many"},        {"-l", "0"},
             {"-m", "-1"},          {"-r", "0", "10"},
             {"-r", "10"},          {"-r", "100000", "10"},
             {"--min-bounce", "9"}, {"-a", "0", "0.05"},
             {"-a", "1.5", "0.05"}, {"-a", "32", "-1"},
             {"--roulette", "1"},   {"--roulette", "sometimes"},
             {"--camera", "left"},  {"--crop", "0", "0", "0", "5"},
             {"-q", "-v"},          {"-H", "--direct", "bsdf"},
             {"--noise", "0"},      {"--noise", "0.1", "-a", "32", "0.05"},
             {"--time", "-1"},      {"--time", "nan"},
             {"--no-such-option"},  {"second.dae"}}) {
        std::vector<std::string> arguments = {"render", "a.dae", "-o", "a.png"};
        arguments.insert(arguments.end(), extra.begin(), extra.end());
        EXPECT_THROW(parse(arguments), UsageError) << extra[0];
    }
    EXPECT_THROW(parse({}), UsageError);
    EXPECT_THROW(parse({"paint"}), UsageError);
    EXPECT_THROW(parse({"render", "a.dae"}), UsageError); // no output
}

} // namespace
} // namespace stromboli
