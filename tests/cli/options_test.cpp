// What the command line means.
#include "host/cli/command_line.hpp"
#include "host/cli/cs184_options.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "host/cs184/cs184.hpp"
#include "tests/cli/parse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

using test::parse;

TEST(Options, Defaults) {
    const RenderOptions o = parse({"render", "a.dae", "-o", "a.png"});
    EXPECT_EQ(o.scene.source, "a.dae");
    EXPECT_EQ(o.output.file, "a.png");
    EXPECT_EQ(o.picture.budget.meanPathsPerPixel, 64u);
    EXPECT_EQ(o.picture.estimator.maxBounces, 8u);
    EXPECT_FALSE(o.picture.budget.adaptive.enabled);
    EXPECT_EQ(o.picture.estimator.roulette.mode, Roulette::Mode::Throughput);
    EXPECT_FALSE(o.picture.size);
}

/// A command line without the program, as a shell takes it apart.
std::vector<std::string> wordsOfExample(const std::string& line) {
    std::vector<std::string> words(1);
    bool isQuoted = false;
    for (const char c : line) {
        if (c == '"')
            isQuoted = !isQuoted;
        else if (c == ' ' && !isQuoted)
            words.emplace_back();
        else
            words.back() += c;
    }
    words.erase(words.begin());
    return words;
}

TEST(Options, ExamplesOfTheHelpAreUnderstood) {
    for (const DeclaredCommand& c : declareCommands()) {
        EXPECT_EQ(c.examples.size(), 3u) << c.name;
        EXPECT_FALSE(c.group.empty()) << c.name;
        for (const std::string& example : c.examples) {
            EXPECT_NE(c.footer.find("\n  " + example), std::string::npos) << example;
            EXPECT_NO_THROW(test::parseAny(wordsOfExample(example))) << example;
        }
    }
}

/// Of many options some dozen come first.
TEST(Options, LongHelpBeginsWithTheUsualOnes) {
    for (const DeclaredCommand& c : declareCommands()) {
        const auto count = [&](auto&& what) { return std::ranges::count_if(c.list.all(), what); };
        const auto shown = count([](const CommandOption& o) { return !o.isHidden; });
        const auto common = count([](const CommandOption& o) { return o.isCommon; });
        const bool isLong = shown > 16;
        EXPECT_GE(common, isLong ? 8 : 0) << c.name << " has " << shown;
        EXPECT_LE(common, isLong ? 13 : 0) << c.name << " has " << shown;
    }
}

TEST(Options, OfTheView) {
    const auto o = parse<ViewOptions>(
        {"view", "a.dae",      "-s",   "9",         "--port", "8080",  "--look-from",
         "1",    "2",          "3",    "-r",        "20",     "10",    "--view",
         "agx",  "--exposure", "-1.5", "--denoise", "on",     "--env", "0.5"});
    EXPECT_EQ(o.port, 8080u);
    EXPECT_EQ(o.host, "127.0.0.1");
    EXPECT_EQ(o.viewTransform, View::AgX);
    EXPECT_EQ(o.exposure, "-1.5");
    EXPECT_TRUE(o.denoised);
    // What the page has a word in is added when the command is asked for.
    EXPECT_EQ(o.command,
              (std::vector<std::string>{"stromboli render", "a.dae", "--env 0.5", "-s 9"}));
    EXPECT_EQ(o.cameraWords, (std::vector<std::string>{"--look-from 1 2 3"}));
    EXPECT_EQ(parse<ViewOptions>({"view", "a.dae"}).exposure, "auto");
    for (const std::vector<std::string>& extra : std::vector<std::vector<std::string>>{
             {"--port", "65536"}, {"--exposure", "x"}, {"--cs184"}, {"-o", "a.png"}}) {
        std::vector<std::string> words = {"view", "a.dae"};
        words.insert(words.end(), extra.begin(), extra.end());
        EXPECT_THROW(parse<ViewOptions>(words), UsageError) << extra[0];
    }
}

TEST(Options, WhoWatchesARender) {
    const RenderOptions o = parse({"render", "a.dae", "-o", "a.png", "--watch", "0", "--update",
                                   "live.png:2.5", "--tev", "localhost:14158"});
    EXPECT_EQ(o.watch.port, 0u);
    EXPECT_EQ(o.watch.updateFile, "live.png");
    EXPECT_EQ(o.watch.updateSeconds, 2.5);
    EXPECT_EQ(o.watch.tev, "localhost:14158");
    EXPECT_EQ(o.command.size(), 2u); // the picture is the same
    const RenderOptions usual = parse({"render", "a.dae", "-o", "a.png", "--update", "live.png"});
    EXPECT_EQ(usual.watch.updateFile, "live.png");
    EXPECT_EQ(usual.watch.updateSeconds, 5);
    EXPECT_FALSE(usual.watch.port);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "--update", "live.png:x"}), UsageError);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.film", "--share", "1/2", "--watch", "0"}),
                 UsageError);
}

TEST(Options, EverythingGiven) {
    const RenderOptions o =
        parse({"render", "a.dae",      "-o",        "a.png",      "-s",    "9",
               "-l",     "3",          "-m",        "4",          "-r",    "20",
               "10",     "-a",         "8",         "0.1",        "-H",    "--min-bounce",
               "2",      "--roulette", "0.25",      "--camera",   "frame", "--seed",
               "5",      "--backend",  "reference", "--exposure", "-1.5",  "--crop",
               "1",      "2",          "3",         "4",          "-q"});
    EXPECT_EQ(o.picture.budget.mostPathsPerPixel, 9u);
    EXPECT_EQ(o.picture.estimator.lightSamples, 3u);
    EXPECT_EQ(o.picture.estimator.maxBounces, 4u);
    EXPECT_EQ(o.picture.size->width, 20u);
    EXPECT_EQ(o.picture.size->height, 10u);
    EXPECT_TRUE(o.picture.budget.adaptive.enabled);
    EXPECT_EQ(o.picture.budget.adaptive.batch, 8u);
    EXPECT_EQ(o.picture.budget.adaptive.tolerance, 0.1);
    EXPECT_EQ(o.picture.estimator.directLight, DirectLight::Hemisphere);
    EXPECT_EQ(o.picture.estimator.minBounce, 2u);
    EXPECT_EQ(o.picture.estimator.roulette.mode, Roulette::Mode::Fixed);
    EXPECT_EQ(o.picture.estimator.roulette.terminationProbability, 0.25);
    EXPECT_EQ(o.picture.camera.choice, CameraChoice::Frame);
    EXPECT_EQ(o.picture.estimator.seed, 5u);
    EXPECT_EQ(o.device.backend, BackendChoice::Reference);
    EXPECT_EQ(o.tone.curve.exposure, -1.5);
    EXPECT_EQ(o.picture.crop.height, 4u);
}

TEST(Options, HowMuchIsSaidIsOfEveryCommand) {
    EXPECT_EQ(test::parseAny({"info", "a.dae", "-q"}).host.verbosity, Verbosity::Quiet);
    EXPECT_EQ(test::parseAny({"bench", "-v"}).host.verbosity, Verbosity::Verbose);
    EXPECT_EQ(test::parseAny({"stress", "-t", "3"}).host.threads, 3u);
}

TEST(Options, Samplers) {
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png"}).picture.estimator.sampler, Sampler::Sobol);
    EXPECT_EQ(parse<CheckOptions>({"check", "a.dae", "--sampler", "independent"})
                  .picture.estimator.sampler,
              Sampler::Independent);
    // That renderer's samples are independent; its adaptive rule counts on it.
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.png", "--cs184"}).picture.estimator.sampler,
              Sampler::Independent);
    EXPECT_EQ(parse<InfoOptions>({"info", "a.dae", "--cs184", "--sampler", "sobol"})
                  .picture.estimator.sampler,
              Sampler::Sobol);
    EXPECT_THROW(parse({"render", "a.dae", "-o", "a.png", "--sampler", "halton"}), UsageError);
}

TEST(Options, StopRules) {
    const RenderOptions noise = parse({"render", "a.dae", "-o", "a.png", "--noise", "0.02"});
    EXPECT_EQ(noise.picture.budget.stop.noise, 0.02);
    EXPECT_FALSE(noise.picture.budget.mostPathsPerPixel); // no limit but the noise
    const RenderOptions both = parse({"render", "a.dae", "-o", "a.png", "--cs184", "--noise",
                                      "0.02", "--time", "10", "-s", "500"});
    EXPECT_EQ(both.picture.budget.stop.seconds, 10);
    EXPECT_EQ(both.picture.budget.mostPathsPerPixel, 500u);
    EXPECT_FALSE(both.picture.budget.adaptive.enabled);
}

TEST(Options, SamplesAreSpreadUnlessSomethingElseIsAsked) {
    const PathBudget spread = parse({"render", "a.dae", "-o", "a.png", "-s", "40"}).picture.budget;
    EXPECT_EQ(spread.meanPathsPerPixel, 40u);
    EXPECT_FALSE(spread.mostPathsPerPixel);
    for (const std::vector<std::string>& evenly : {std::vector<std::string>{"--even"},
                                                   {"--cs184", "--even"},
                                                   {"-s", "8"},
                                                   {"--cs184"},
                                                   {"-a", "32", "0.1"}}) {
        std::vector<std::string> words = {"render", "a.dae", "-o", "a.png"};
        words.insert(words.end(), evenly.begin(), evenly.end());
        const PathBudget s = parse(words).picture.budget;
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
    EXPECT_FALSE(parse<CheckOptions>({"check", "a.dae", "-s", "64"}).picture.budget.spreads());
}

TEST(Options, Cs184ChangesDefaults) {
    const RenderOptions o = parse({"render", "a.dae", "-o", "a.png", "--cs184"});
    EXPECT_EQ(o.picture.budget.mostPathsPerPixel, 1u);
    EXPECT_EQ(o.picture.estimator.maxBounces, 1u);
    EXPECT_TRUE(o.picture.budget.adaptive.enabled);
    EXPECT_EQ(o.picture.budget.adaptive.batch, 32u);
    EXPECT_EQ(o.picture.estimator.roulette.mode, Roulette::Mode::None);
}

/// All that the option stands for, by its name; without it, the default of each.
TEST(Options, Cs184IsResolvedIntoConventions) {
    const RenderOptions none = parse({"render", "a.dae", "-o", "a.png", "-s", "100"});
    EXPECT_TRUE(none.scene.reading.areDefault());
    EXPECT_FALSE(none.picture.framing.pictureSize || none.picture.framing.framesEveryScene ||
                 none.picture.framing.clipsAlongRay);
    EXPECT_EQ(none.picture.estimator.conventions, ShadingConventions{});
    EXPECT_EQ(none.tone.curve.kind, ToneCurve::Kind::Srgb);
    EXPECT_EQ(none.picture.budget.adaptive.rule, Adaptive::Rule::Neighbourhood);
    EXPECT_FALSE(none.picture.branches);
    const RenderOptions o = parse({"render", "a.dae", "-o", "a.png", "-s", "100", "--cs184"});
    EXPECT_EQ(o.scene.reading.option, "--cs184");
    EXPECT_TRUE(o.picture.framing.pictureSize && o.picture.framing.framesEveryScene &&
                o.picture.framing.clipsAlongRay);
    EXPECT_EQ(o.picture.estimator.conventions, cs184Shading());
    EXPECT_EQ(o.tone.curve.kind, ToneCurve::Kind::Power);
    EXPECT_EQ(o.picture.budget.adaptive.rule, Adaptive::Rule::PerChannel);
    EXPECT_EQ(o.picture.branches, 1u);
    // Its pixels have as many samples each, where the adaptive rule has nothing to look at too.
    EXPECT_FALSE(
        parse({"render", "a.dae", "-o", "a.png", "-s", "100", "--cs184", "--integrator", "normals"})
            .picture.budget.spreads());
}

TEST(Options, Cs184Spellings) {
    const RenderOptions o =
        parse({"render", "-t",  "4",  "-s", "2",  "-m", "3",  "-o", "0",     "-r",
               "480",    "360", "-p", "10", "20", "30", "40", "-f", "a.png", "a.dae"});
    EXPECT_EQ(o.output.file, "a.png");
    EXPECT_EQ(o.picture.estimator.minBounce, 3u); // -o 0: only the light of exactly m bounces
    EXPECT_EQ(o.device.threads, 4u);
    EXPECT_EQ(o.picture.crop.x, 10u);
    EXPECT_EQ(o.picture.crop.y, 360u - 20 - 40); // Y counts from the bottom
    EXPECT_EQ(
        parse({"render", "a.dae", "-f", "a.png", "-o", "1", "-m", "3"}).picture.estimator.minBounce,
        0u);
}

TEST(Options, SceneMayFollowAnOptionWithSeveralValues) {
    EXPECT_EQ(parse({"render", "-o", "a.png", "-r", "8", "9", "a.dae"}).scene.source, "a.dae");
    EXPECT_EQ(parse({"render", "-o", "a.png", "-a", "8", "0.1", "a.dae"}).scene.source, "a.dae");
    EXPECT_EQ(parse({"render", "-o", "a.png", "--crop", "0", "0", "8", "9", "a.dae"}).scene.source,
              "a.dae");
}

TEST(Options, ClampedLightIsAskedFor) {
    const std::vector<std::string> words = {"render", "a.dae", "-o", "a.png"};
    EXPECT_EQ(parse(words).picture.estimator.indirectLimit, 0);
    std::vector<std::string> clamped = words;
    clamped.insert(clamped.end(), {"--clamp-indirect", "2.5"});
    EXPECT_EQ(parse(clamped).picture.estimator.indirectLimit, 2.5);
    for (const char* wrong : {"0", "-1", "nan", "inf"}) {
        clamped.back() = wrong;
        EXPECT_THROW(parse(clamped), UsageError) << wrong;
    }
}

TEST(Options, SpellingLeavesOutputsAlone) {
    EXPECT_EQ(fromCs184Spelling({"-o", "0.png"}), (std::vector<std::string>{"-o", "0.png"}));
    EXPECT_EQ(fromCs184Spelling({"-o", "0"}), (std::vector<std::string>{"--accumulate", "0"}));
}

TEST(Options, AShareIsEvenAndSaysSoInItsCommand) {
    const RenderOptions share =
        parse({"render", "a.dae", "-o", "a.film", "--share", "3/16", "-s", "96"});
    const RenderOptions whole = parse({"render", "a.dae", "-o", "a.exr", "-s", "96", "--even"});
    EXPECT_EQ(*share.share.share, (ShareName{3, 16}));
    EXPECT_FALSE(share.picture.budget.spreads());
    EXPECT_EQ(share.picture.budget.mostPathsPerPixel, 96u);
    EXPECT_EQ(share.picture.budget.pathsPerBlock, 128u);
    EXPECT_EQ(share.command, whole.command);
    EXPECT_EQ(whole.picture.budget.pathsPerBlock, 128u);
    EXPECT_EQ(parse({"render", "a.dae", "-o", "a.exr", "-s", "96"}).picture.budget.pathsPerBlock,
              0u);
    EXPECT_EQ(inSamples(share.picture.budget, 4).samplesPerBlock, 32u);
    EXPECT_EQ(inSamples(share.picture.budget, 3).samplesPerBlock, 42u);
    EXPECT_EQ(inSamples(share.picture.budget, 200).samplesPerBlock, 1u);
}

TEST(Options, SubmitTellsSharesAndMergeWhatIsTheirs) {
    const SubmitOptions o =
        parse<SubmitOptions>({"submit",  "slurm",    "a b.xml",  "-o",  "a.exr",         "--shares",
                              "4",       "-D",       "x=1",      "-D",  "y=2",           "--aov",
                              "--notes", "off",      "--device", "cpu", "--transparent", "--noise",
                              "0.02",    "--rounds", "3"});
    EXPECT_EQ(o.render, (Words{"'a b.xml'", "-D x=1 -D y=2", "--transparent", "--device cpu"}));
    EXPECT_EQ(o.merge, (Words{"--aov", "--notes off"}));
    EXPECT_EQ(o.noise, 0.02);
    EXPECT_EQ(o.rounds, 3u);
    EXPECT_TRUE(o.picture.transparent);
    EXPECT_FALSE(o.picture.budget.spreads());
}

/// Profiles change what options are by default, wherever they stand; what is given is kept.
TEST(Options, ProfilesChangeOnlyDefaults) {
    const RenderOptions o = parse({"render", "a.dae", "-o", "a.png", "-m", "6", "-s", "9",
                                   "--sampler", "sobol", "--roulette", "0.5", "--cs184"});
    EXPECT_EQ(o.picture.estimator.maxBounces, 6u);
    EXPECT_EQ(o.picture.budget.mostPathsPerPixel, 9u);
    EXPECT_EQ(o.picture.estimator.sampler, Sampler::Sobol);
    EXPECT_EQ(o.picture.estimator.roulette.mode, Roulette::Mode::Fixed);
    const BenchOptions bench =
        parse<BenchOptions>({"bench", "-s", "3", "--repeats", "2", "--quick"});
    EXPECT_EQ(bench.settings.samplesPerPixel, 3u);
    EXPECT_EQ(bench.settings.repeats, 2u);
    EXPECT_EQ(bench.settings.width, 192u);
    const StudyOptions study = parse<StudyOptions>({"study", "a.dae", "--seeds", "2", "--quick"});
    EXPECT_EQ(study.settings.seeds, 2u);
    EXPECT_EQ(study.settings.commonOptions, "-r 160 120 -m 5");
}

/// Each command has defaults of its own.
TEST(Options, DefaultsOfCommands) {
    const CheckOptions check = parse<CheckOptions>({"check", "a.dae"});
    ASSERT_TRUE(check.picture.size);
    EXPECT_EQ(check.picture.size->width, 160u);
    EXPECT_EQ(check.picture.size->height, 120u);
    EXPECT_EQ(check.picture.budget.mostPathsPerPixel, 256u);
    EXPECT_EQ(check.picture.branches, 1u);
    EXPECT_FALSE(
        parse<CheckOptions>({"check", "a.dae", "--cs184"}).picture.budget.adaptive.enabled);
    EXPECT_FALSE(parse<InfoOptions>({"info", "a.dae"}).picture.branches);
}

/// Values of an enumeration, by name.
template <class E>
void expectEveryName(const std::string& option, E (*value)(const RenderOptions&)) {
    for (const NamedValue<E>& row : kNamedValues<E>)
        EXPECT_EQ(value(parse({"render", "a.dae", "-o", "a.png", option, row.name})), row.value)
            << row.name;
}

TEST(Options, EveryNameOfATableIsUnderstood) {
    expectEveryName<DirectLight>(
        "--direct", [](const RenderOptions& o) { return o.picture.estimator.directLight; });
    expectEveryName<Sampler>("--sampler",
                             [](const RenderOptions& o) { return o.picture.estimator.sampler; });
    expectEveryName<LightChoice>(
        "--light-choice", [](const RenderOptions& o) { return o.picture.estimator.lightChoice; });
    expectEveryName<Integrator>(
        "--integrator", [](const RenderOptions& o) { return o.picture.estimator.integrator; });
    expectEveryName<CameraChoice>("--camera",
                                  [](const RenderOptions& o) { return o.picture.camera.choice; });
    expectEveryName<BackendChoice>("--backend",
                                   [](const RenderOptions& o) { return o.device.backend; });
}

} // namespace
} // namespace stromboli
