// What the command line refuses, and what the messages name.
#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "tests/cli/parse.hpp"
#include "tests/support/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

using test::parseAny;

/// What is not in the range of an option is refused by a message that names the option and the
/// range.
TEST(RefusedOptions, RangesAreNamed) {
    const auto refusal = [](const std::vector<std::string>& words) {
        return test::refusalOf([&] { parseAny(words); });
    };
    const std::vector<std::pair<std::vector<std::string>, std::string>> renders = {
        {{"-s", "0"}, "-s is '0': expected a whole number from 1 to 16777216"},
        {{"-s", "nan"}, "-s is 'nan': expected a whole number from 1 to 16777216"},
        {{"-s", "1.5"}, "-s is '1.5': expected a whole number from 1 to 16777216"},
        {{"-l", ""}, "-l is '': expected a whole number from 1 to 1024"},
        {{"--time", "nan"},
         "--time is 'nan': expected a number from 0.01 to 1000000000, maybe with its unit: h, min, "
         "m, s, ms"},
        {{"--time", "inf"},
         "--time is 'inf': expected a number from 0.01 to 1000000000, maybe with its unit: h, min, "
         "m, s, ms"},
        {{"--noise", "0.1x"},
         "--noise is '0.1x': expected a number from 1e-06 to 1000000, maybe with its unit: %"},
        {{"--exposure", "nan"}, "--exposure is 'nan': expected auto or a number from -100 to 100"},
        {{"-a", "32", "nan"},
         "-a: TOLERANCE is 'nan': expected a number from 0 to 1000000, maybe with its unit: %"},
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
        if (o.name() == option.name() && !o.ifMissing.empty()) { // else they belong to others
            line.push_back(o.name() + "=" + words.front());
            continue;
        }
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

void expectRefusal(const DeclaredCommand& c, const CommandOption& o, const std::string& bad,
                   uint32_t place) {
    std::vector<std::string> words(o.wordCount, "1");
    words[place] = bad;
    const std::string message = test::refusalOf([&] { parseAny(lineWith(c, o, words)); });
    EXPECT_EQ(message.rfind(o.name(), 0), 0u)
        << c.name << " " << o.name() << " '" << bad << "' in place " << place << ": "
        << (message.empty() ? "accepted" : message);
    EXPECT_NE(message.find("expected"), std::string::npos) << message;
}

TEST(RefusedOptions, EveryOptionOfEveryCommandRefusesWhatIsNoValue) {
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

TEST(RefusedOptions, ContradictionsAreRefused) {
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
                                               {"--cs184", "--terminator-offset", "on"},
                                               {"-a", "0", "0.05"},
                                               {"-a", "1.5", "0.05"},
                                               {"-a", "32", "-1"},
                                               {"--roulette", "1"},
                                               {"--roulette", "sometimes"},
                                               {"--default-light", "dim"},
                                               {"--camera", ""},
                                               {"--camera", "2", "--look-from", "0", "0", "1"},
                                               {"--look-at", "0", "0", "1"},
                                               {"--focus", "far"},
                                               {"--focus", "3,4,5"},
                                               {"--focus", "3,-4"},
                                               {"--focus", "0"},
                                               {"--aperture", "5 mm", "--focus", "5m"},
                                               {"--aperture", "0", "--focus", "5m"},
                                               {"--fov", "180"},
                                               {"--env-strength", "2"},
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
        EXPECT_THROW(parseAny(arguments), UsageError) << extra[0];
    }
    EXPECT_THROW(parseAny({}), UsageError);
    EXPECT_THROW(parseAny({"paint"}), UsageError);
    EXPECT_THROW(parseAny({"render", "a.dae"}), UsageError); // no output
}

} // namespace
} // namespace stromboli
