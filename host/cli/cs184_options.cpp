#include "host/cli/cs184_options.hpp"

#include "host/cli/word_spelling.hpp"
#include "host/core/text.hpp"
#include "host/cs184/cs184.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// That renderer's conventions, each by its name, and its defaults. What is below the command line
/// knows of the conventions and not of the option.
void useCs184(SceneAndPicture& work, Asked& asked) {
    RenderRequest& picture = work.picture;
    work.scene.reading = cs184Conventions();
    picture.framing = cs184Framing();
    picture.estimator.conventions = cs184Shading();
    work.tone.curve.kind = ToneCurve::Kind::Power;
    picture.budget.adaptive.rule = Adaptive::Rule::PerChannel;

    picture.estimator.maxBounces = 1;
    picture.estimator.sampler = Sampler::Independent;
    picture.estimator.roulette.mode = Roulette::Mode::None;
    picture.branches = 1;
    picture.budget.adaptive.enabled = true;
    if (asked.makes == Makes::Pictures) asked.usualPaths = 1; // one sample checks nothing
    asked.usuallySpread = false;
}

} // namespace

void declareCs184(OptionList& list, SceneAndPicture& work, Asked& asked) {
    const Adaptive& a = work.picture.budget.adaptive;
    std::vector<std::pair<std::string, std::string>> defaults = {
        {"--default-light", "off"},
        {"-m", "1"},
        {"--roulette", "none"},
        {"--terminator-offset", "off"},
        {"--sampler", nameOf(Sampler::Independent)},
        {"-a", fmt::format("{} {}", a.batch, a.tolerance)}};
    if (asked.makes == Makes::Pictures) defaults.emplace_back("-s", "1");
    CommandOption& option =
        list.flag(
                "--cs184",
                "the CS184 renderer's conventions: framing and crop, the last of several cameras, "
                "normals, lights, tone curve, adaptive sampling by default (docs/guide/cs184.md)",
                [&work, &asked] { useCs184(work, asked); })
            .changesDefaults(std::move(defaults))
            .excludes("--view", "it has a tone curve of its own");
    for (const char* other : {"--env", "--sun", "--ground", "--portal", "--portals", "--fog",
                              "--shadow-catcher", "--clamp-indirect", "--preset"})
        option.excludes(other);
}

Words fromCs184Spelling(Words arguments) {
    for (size_t i = 0; i < arguments.size(); ++i) {
        std::string& a = arguments[i];
        const bool numberFollows = i + 1 < arguments.size() && isWholeNumber(arguments[i + 1]);
        if (a == "-f")
            a = "-o";
        else if (a == "-o" && numberFollows)
            a = "--accumulate";
        else if (a == "-p")
            a = "--cell";
    }
    return arguments;
}

} // namespace stromboli
