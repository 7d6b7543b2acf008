// What the command line means.
#include "host/cli/cs184_spelling.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "tests/cli/parse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

using test::parse;

TEST(Options, Defaults) {
    const Options o = parse({"render", "a.dae", "-o", "a.png"});
    EXPECT_EQ(o.command, Command::Render);
    EXPECT_EQ(o.scene, "a.dae");
    EXPECT_EQ(o.output, "a.png");
    EXPECT_EQ(o.budget.meanPathsPerPixel, 64u);
    EXPECT_EQ(o.estimator.maxBounces, 8u);
    EXPECT_FALSE(o.budget.adaptive.enabled);
    EXPECT_EQ(o.estimator.roulette.mode, Roulette::Mode::Throughput);
    EXPECT_FALSE(o.sizeGiven);
}

TEST(Options, EverythingGiven) {
    const Options o =
        parse({"render", "a.dae",      "-o",        "a.png",      "-s",    "9",
               "-l",     "3",          "-m",        "4",          "-r",    "20",
               "10",     "-a",         "8",         "0.1",        "-H",    "--min-bounce",
               "2",      "--roulette", "0.25",      "--camera",   "frame", "--seed",
               "5",      "--backend",  "reference", "--exposure", "-1.5",  "--crop",
               "1",      "2",          "3",         "4",          "-q"});
    EXPECT_EQ(o.budget.mostPathsPerPixel, 9u);
    EXPECT_EQ(o.estimator.lightSamples, 3u);
    EXPECT_EQ(o.estimator.maxBounces, 4u);
    EXPECT_EQ(o.area.width, 20u);
    EXPECT_EQ(o.area.height, 10u);
    EXPECT_TRUE(o.budget.adaptive.enabled);
    EXPECT_EQ(o.budget.adaptive.batch, 8u);
    EXPECT_EQ(o.budget.adaptive.tolerance, 0.1);
    EXPECT_EQ(o.estimator.directLight, DirectLight::Hemisphere);
    EXPECT_EQ(o.estimator.minBounce, 2u);
    EXPECT_EQ(o.estimator.roulette.mode, Roulette::Mode::Fixed);
    EXPECT_EQ(o.estimator.roulette.terminationProbability, 0.25);
    EXPECT_EQ(o.camera.choice, CameraChoice::Frame);
    EXPECT_EQ(o.estimator.seed, 5u);
    EXPECT_EQ(o.backend, BackendChoice::Reference);
    EXPECT_EQ(o.tone.exposure, -1.5);
    EXPECT_EQ(o.area.crop.height, 4u);
    EXPECT_EQ(o.verbosity, Verbosity::Quiet);
}

TEST(Options, Samplers) {
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png"}).estimator.sampler, Sampler::Sobol);
    EXPECT_EQ(parse({"check", "a.dae", "--sampler", "independent"}).estimator.sampler,
              Sampler::Independent);
    // That renderer's samples are independent; its adaptive rule counts on it.
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "--cs184"}).estimator.sampler,
              Sampler::Independent);
    EXPECT_EQ(parse({"info", "a.dae", "--cs184", "--sampler", "sobol"}).estimator.sampler,
              Sampler::Sobol);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "--sampler", "halton"}), UsageError);
}

TEST(Options, StopRules) {
    const Options noise = parse({"render", "a.dae", "-o", "a.png", "--noise", "0.02"});
    EXPECT_EQ(noise.budget.stop.noise, 0.02);
    EXPECT_FALSE(noise.budget.mostPathsPerPixel); // no limit but the noise
    const Options both = parse({"render", "a.dae", "-o", "a.png", "--cs184", "--noise", "0.02",
                                "--time", "10", "-s", "500"});
    EXPECT_EQ(both.budget.stop.seconds, 10);
    EXPECT_EQ(both.budget.mostPathsPerPixel, 500u);
    EXPECT_FALSE(both.budget.adaptive.enabled);
}

TEST(Options, SamplesAreSpreadUnlessSomethingElseIsAsked) {
    const PathBudget spread = parse({"render", "a.dae", "-o", "a.png", "-s", "40"}).budget;
    EXPECT_EQ(spread.meanPathsPerPixel, 40u);
    EXPECT_FALSE(spread.mostPathsPerPixel);
    for (const std::vector<std::string>& evenly : {std::vector<std::string>{"--even"},
                                                   {"--cs184", "--even"},
                                                   {"-s", "8"},
                                                   {"--cs184"},
                                                   {"-a", "32", "0.1"}}) {
        std::vector<std::string> words = {"render", "a.dae", "-o", "a.png"};
        words.insert(words.end(), evenly.begin(), evenly.end());
        const PathBudget s = parse(words).budget;
        EXPECT_FALSE(s.spreads()) << evenly[0];
        EXPECT_LE(s.mostPathsPerPixel.value_or(kMostSamples), 64u) << evenly[0];
        EXPECT_EQ(s.adaptive.enabled, evenly[0] == "-a" || words.back() == "--cs184");
    }
    for (const std::vector<std::string>& both :
         {std::vector<std::string>{"-a", "32", "0.1"}, {"--noise", "0.1"}, {"--time", "1"}}) {
        std::vector<std::string> words = {"render", "a.dae", "-o", "a.png", "--even"};
        words.insert(words.end(), both.begin(), both.end());
        EXPECT_THROW(parse(words), UsageError) << both[0];
    }
    EXPECT_FALSE(parse({"check", "a.dae", "-s", "64"}).budget.spreads());
}

TEST(Options, Cs184ChangesDefaults) {
    const Options o = parse({"render", "a.dae", "-o", "a.png", "--cs184"});
    EXPECT_EQ(o.budget.mostPathsPerPixel, 1u);
    EXPECT_EQ(o.estimator.maxBounces, 1u);
    EXPECT_TRUE(o.budget.adaptive.enabled);
    EXPECT_EQ(o.budget.adaptive.batch, 32u);
    EXPECT_EQ(o.estimator.roulette.mode, Roulette::Mode::None);
}

/// All that the option stands for, by its name; without it, the default of each.
TEST(Options, Cs184IsResolvedIntoConventions) {
    const Options none = parse({"render", "a.dae", "-o", "a.png", "-s", "100"});
    EXPECT_TRUE(none.reading.areDefault());
    EXPECT_FALSE(none.framing.pictureSize || none.framing.framesEveryScene ||
                 none.framing.clipsAlongRay);
    EXPECT_EQ(none.estimator.conventions, ShadingConventions{});
    EXPECT_EQ(none.tone.kind, ToneCurve::Kind::Srgb);
    EXPECT_EQ(none.budget.adaptive.rule, Adaptive::Rule::Neighbourhood);
    EXPECT_FALSE(none.branches);
    const Options o = parse({"render", "a.dae", "-o", "a.png", "-s", "100", "--cs184"});
    EXPECT_EQ(o.reading.option, "--cs184");
    EXPECT_TRUE(o.framing.pictureSize && o.framing.framesEveryScene && o.framing.clipsAlongRay);
    EXPECT_EQ(o.estimator.conventions, cs184Shading());
    EXPECT_EQ(o.tone.kind, ToneCurve::Kind::Cs184);
    EXPECT_EQ(o.budget.adaptive.rule, Adaptive::Rule::PerChannel);
    EXPECT_EQ(o.branches, 1u);
    // Its pixels have as many samples each, where the adaptive rule has nothing to look at too.
    EXPECT_FALSE(
        parse({"render", "a.dae", "-o", "a.png", "-s", "100", "--cs184", "--integrator", "normals"})
            .budget.spreads());
}

TEST(Options, Cs184Spellings) {
    const Options o =
        parse({"render", "-t",  "4",  "-s", "2",  "-m", "3",  "-o", "0",     "-r",
               "480",    "360", "-p", "10", "20", "30", "40", "-f", "a.png", "a.dae"});
    EXPECT_EQ(o.output, "a.png");
    EXPECT_EQ(o.estimator.minBounce, 3u); // -o 0: only the light of exactly m bounces
    EXPECT_EQ(o.threads, 4u);
    EXPECT_EQ(o.area.crop.x, 10u);
    EXPECT_EQ(o.area.crop.y, 360u - 20 - 40); // Y counts from the bottom
    EXPECT_EQ(parse({"render", "a.dae", "-f", "a.png", "-o", "1", "-m", "3"}).estimator.minBounce,
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

TEST(Options, AShareIsEvenAndSaysSoInItsCommand) {
    const Options share = parse({"render", "a.dae", "-o", "a.film", "--share", "3/16", "-s", "96"});
    const Options whole = parse({"render", "a.dae", "-o", "a.exr", "-s", "96", "--even"});
    EXPECT_EQ(*share.share, (ShareName{3, 16}));
    EXPECT_FALSE(share.budget.spreads());
    EXPECT_EQ(share.budget.mostPathsPerPixel, 96u);
    EXPECT_EQ(share.budget.pathsPerBlock, 128u);
    EXPECT_EQ(share.pictureCommand, whole.pictureCommand);
    EXPECT_EQ(whole.budget.pathsPerBlock, 128u);
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.exr", "-s", "96"}).budget.pathsPerBlock, 0u);
    EXPECT_EQ(inSamples(share.budget, 4).samplesPerBlock, 32u);
    EXPECT_EQ(inSamples(share.budget, 3).samplesPerBlock, 42u);
    EXPECT_EQ(inSamples(share.budget, 200).samplesPerBlock, 1u);
}

TEST(Options, SubmitTellsSharesAndMergeWhatIsTheirs) {
    const Options o = parse({"submit",  "slurm",    "a b.xml",  "-o",  "a.exr",         "--shares",
                             "4",       "-D",       "x=1",      "-D",  "y=2",           "--aov",
                             "--notes", "off",      "--device", "cpu", "--transparent", "--noise",
                             "0.02",    "--rounds", "3"});
    EXPECT_EQ(o.submit.render,
              (Words{"'a b.xml'", "-D x=1 -D y=2", "--transparent", "--device cpu"}));
    EXPECT_EQ(o.submit.merge, (Words{"--aov", "--notes off"}));
    EXPECT_EQ(o.submit.noise, 0.02);
    EXPECT_EQ(o.submit.rounds, 3u);
    EXPECT_FALSE(o.estimator.showsBackdrop);
    EXPECT_FALSE(o.budget.spreads());
}

TEST(Options, NumbersHaveExponentsAndUnits) {
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "-s", "2.5k"}).budget.meanPathsPerPixel,
              2500u);
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "-s", "1e6"}).budget.meanPathsPerPixel,
              1'000'000u);
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "--time", "1k"}).budget.stop.seconds, 1000);
    EXPECT_EQ(parse({"bench", "--sizes", "1k,2.5M"}).bench.settings.sizes,
              (std::vector<uint64_t>{1000, 2'500'000}));
}

/// Profiles change what options are by default, wherever they stand; what is given is kept.
TEST(Options, ProfilesChangeOnlyDefaults) {
    const Options o = parse({"render", "a.dae", "-o", "a.png", "-m", "6", "-s", "9", "--sampler",
                             "sobol", "--roulette", "0.5", "--cs184"});
    EXPECT_EQ(o.estimator.maxBounces, 6u);
    EXPECT_EQ(o.budget.mostPathsPerPixel, 9u);
    EXPECT_EQ(o.estimator.sampler, Sampler::Sobol);
    EXPECT_EQ(o.estimator.roulette.mode, Roulette::Mode::Fixed);
    const Options bench = parse({"bench", "-s", "3", "--repeats", "2", "--quick"});
    EXPECT_EQ(bench.bench.settings.samplesPerPixel, 3u);
    EXPECT_EQ(bench.bench.settings.repeats, 2u);
    EXPECT_EQ(bench.bench.settings.width, 192u);
    const Options study = parse({"study", "a.dae", "--seeds", "2", "--quick"});
    EXPECT_EQ(study.study.settings.seeds, 2u);
    EXPECT_EQ(study.study.settings.commonOptions, "-r 160 120 -m 5");
}

/// Each command has defaults of its own.
TEST(Options, DefaultsOfCommands) {
    const Options check = parse({"check", "a.dae"});
    EXPECT_EQ(check.area.width, 160u);
    EXPECT_EQ(check.area.height, 120u);
    EXPECT_TRUE(check.sizeGiven);
    EXPECT_EQ(check.budget.mostPathsPerPixel, 256u);
    EXPECT_EQ(check.branches, 1u);
    EXPECT_FALSE(parse({"check", "a.dae", "--cs184"}).budget.adaptive.enabled);
    EXPECT_FALSE(parse({"info", "a.dae"}).branches);
}

/// Values of an enumeration, by name.
template <class E>
void expectEveryName(const std::string& option, E (*value)(const Options&)) {
    for (const NamedValue<E>& row : kNamedValues<E>)
        EXPECT_EQ(value(parse({"render", "a.dae", "-o", "a.png", option, row.name})), row.value)
            << row.name;
}

TEST(Options, EveryNameOfATableIsUnderstood) {
    expectEveryName<DirectLight>("--direct",
                                 [](const Options& o) { return o.estimator.directLight; });
    expectEveryName<Sampler>("--sampler", [](const Options& o) { return o.estimator.sampler; });
    expectEveryName<LightChoice>("--light-choice",
                                 [](const Options& o) { return o.estimator.lightChoice; });
    expectEveryName<Integrator>("--integrator",
                                [](const Options& o) { return o.estimator.integrator; });
    expectEveryName<CameraChoice>("--camera", [](const Options& o) { return o.camera.choice; });
    expectEveryName<BackendChoice>("--backend", [](const Options& o) { return o.backend; });
}

} // namespace
} // namespace stromboli
