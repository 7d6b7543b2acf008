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

/// What is not in the range of an option is refused by a message that names the option and the
/// range.
TEST(Options, RangesAreNamed) {
    const auto refusal = [](std::vector<std::string> words) -> std::string {
        try {
            parse(std::move(words));
        } catch (const UsageError& error) {
            return error.what();
        }
        return "accepted";
    };
    const std::vector<std::pair<std::vector<std::string>, std::string>> renders = {
        {{"-s", "0"}, "-s is '0': expected a whole number from 1 to 16777216"},
        {{"-s", "nan"}, "-s is 'nan': expected a whole number from 1 to 16777216"},
        {{"-s", "1.5"}, "-s is '1.5': expected a whole number from 1 to 16777216"},
        {{"-l", ""}, "-l is '': expected a whole number from 1 to 1024"},
        {{"--time", "nan"}, "--time is 'nan': expected a number from 0.01 to 1000000000"},
        {{"--time", "inf"}, "--time is 'inf': expected a number from 0.01 to 1000000000"},
        {{"--noise", "0.1x"}, "--noise is '0.1x': expected a number from 1e-06 to 1000000"},
        {{"--exposure", "nan"}, "--exposure is 'nan': expected a number from -100 to 100"},
        {{"-a", "32", "nan"}, "-a: TOLERANCE is 'nan': expected a number from 0 to 1000000"},
        {{"--roulette", "nan"},
         "--roulette is 'nan': expected none, throughput or a probability in [0, 1)"},
        {{"--direct", "sun"},
         "--direct is 'sun': expected mis, mis-all, lights, hemisphere or bsdf"},
        {{"--device", ""}, "--device is empty: expected text"},
        {{"--seed", "-1"}, "--seed is '-1': expected a whole number from 0 to 4294967295"},
        {{"--time", "9", "--even"},
         "--time and --even exclude each other: both say where samples "
         "go"}};
    for (const auto& [words, message] : renders) {
        std::vector<std::string> line = {"render", "a.dae", "-o", "a.png"};
        line.insert(line.end(), words.begin(), words.end());
        EXPECT_EQ(refusal(line), message);
    }
    EXPECT_EQ(refusal({"compare", "a.png", "b.png", "--max-mse", "nan"}),
              "--max-mse is 'nan': expected a number from 0 to 1e+300");
    EXPECT_EQ(refusal({"bench", "--repeats", "0"}),
              "--repeats is '0': expected a whole number from 1 to 1000");
    EXPECT_EQ(refusal({"study", "a.dae", "--seeds", "0"}),
              "--seeds is '0': expected a whole number from 1 to 10000");
    EXPECT_EQ(refusal({"check", "a.dae", "--alpha", "nan"}),
              "--alpha is 'nan': expected a number from 1e-12 to 0.5");
}

/// Words that the option understands, where another one needs it.
std::vector<std::string> someValueOf(const CommandOption& o) {
    if (o.name() == "--share") return {"1/2"};
    if (o.isRequired && !o.proposals.empty()) return {o.proposals.front()};
    if (o.isRequired && o.range.empty()) return {"a.exr"};
    return std::vector<std::string>(o.wordCount, "1");
}

/// A complete line of the command in which `option` has these words.
std::vector<std::string> lineWith(const DeclaredCommand& c, const CommandOption& option,
                                  const std::vector<std::string>& words) {
    std::vector<std::string> line = {c.name};
    const auto add = [&](const CommandOption& o, const std::vector<std::string>& values) {
        if (o.name().starts_with("-")) line.push_back(o.name());
        line.insert(line.end(), values.begin(), values.end());
    };
    for (const CommandOption& o : c.list.all()) {
        const bool isNeeded =
            std::find(option.needed.begin(), option.needed.end(), o.name()) != option.needed.end();
        if (o.name() == option.name())
            add(o, words);
        else if (isNeeded || o.isRequired)
            add(o, someValueOf(o));
        else if (o.name() == "-o" && c.name == "render")
            add(o, {"a.exr"});
    }
    return line;
}

/// What no number may be, wherever one is read (the largest of all ranges ends at 1e300); "-1"
/// where the range has none below 0.
std::vector<std::string> badNumbers(const CommandOption& o) {
    std::vector<std::string> words = {"nan",   "inf",   "1x",  "1e400",
                                      "1.2.3", "1e301", "0x1", "-1e301"};
    if (!o.range.starts_with("-")) words.push_back("-1");
    return words;
}

/// The message of the refusal; empty if there is none.
std::string refusalOf(const std::vector<std::string>& line) {
    try {
        parse(line);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

void expectRefusal(const DeclaredCommand& c, const CommandOption& o, const std::string& bad,
                   uint32_t place) {
    std::vector<std::string> words(o.wordCount, "1");
    words[place] = bad;
    const std::string message = refusalOf(lineWith(c, o, words));
    EXPECT_EQ(message.rfind(o.name(), 0), 0u)
        << c.name << " " << o.name() << " '" << bad << "' in place " << place << ": "
        << (message.empty() ? "accepted" : message);
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
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

TEST(Options, EveryOptionOfEveryCommandRefusesWhatIsNoValue) {
    size_t numbers = 0;
    for (const DeclaredCommand& c : declareCommands())
        for (const CommandOption& o : c.list.all())
            for (uint32_t place = 0; place < o.wordCount; ++place) {
                expectRefusal(c, o, "", place);
                if (o.range.empty()) continue;
                ++numbers;
                for (const std::string& bad : badNumbers(o))
                    expectRefusal(c, o, bad, place);
            }
    EXPECT_GT(numbers, 60u); // or ranges are not declared any more
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

TEST(Options, ContradictionsAreRefused) {
    for (const std::vector<std::string>& extra :
         std::vector<std::vector<std::string>>{{"-s", "0"},
                                               {"-s", "99999999999"},
                                               {"-s", "many"},
                                               {"-l", "0"},
                                               {"-m", "-1"},
                                               {"-r", "0", "10"},
                                               {"-r", "10"},
                                               {"-r", "100000", "10"},
                                               {"--min-bounce", "9"},
                                               {"-a", "0", "0.05"},
                                               {"-a", "1.5", "0.05"},
                                               {"-a", "32", "-1"},
                                               {"--roulette", "1"},
                                               {"--roulette", "sometimes"},
                                               {"--default-light", "dim"},
                                               {"--camera", ""},
                                               {"--camera", "2", "--look-from", "0", "0", "1"},
                                               {"--look-at", "0", "0", "1"},
                                               {"--aperture", "5mm"},
                                               {"--focus", "5m"},
                                               {"--aperture", "5 mm", "--focus", "5m"},
                                               {"--aperture", "0", "--focus", "5m"},
                                               {"--fov", "180"},
                                               {"--env-rotate", "90"},
                                               {"--env", "sky.hdr", "--cs184"},
                                               {"--scene", "-1"},
                                               {"--at", "never"},
                                               {"--max-texture", "-8"},
                                               {"--crop", "0", "0", "0", "5"},
                                               {"-q", "-v"},
                                               {"-H", "--direct", "bsdf"},
                                               {"--noise", "0"},
                                               {"--noise", "0.1", "-a", "32", "0.05"},
                                               {"--time", "-1"},
                                               {"--time", "nan"},
                                               {"--no-such-option"},
                                               {"second.dae"}}) {
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
