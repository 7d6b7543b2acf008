#include "host/study/study.hpp"

#include "host/core/error.hpp"
#include "host/core/text.hpp"
#include "host/render/estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace stromboli::study {
namespace {

/// The noise, squared, is relMSE: these are the errors of some 4 to 256 samples of a diffuse scene.
const std::vector<double> kNoise = {0.4, 0.2, 0.1, 0.05};
/// Tolerances from a glance to a final picture; a picture of mean noise 5 % has relMSE 0.0025.
const std::vector<double> kTolerances = {0.8, 0.4, 0.2, 0.1};

/// "-a 16 {0.4,0.2}" becomes "-a 16 {}" and its steps.
void takeSteps(Configuration& c) {
    const size_t open = c.options.find('{'), close = c.options.find('}');
    if (open == std::string::npos) return;
    if (close == std::string::npos || close < open)
        throw UsageError(fmt::format("-c: '{}' has a {{ without a }}", c.options));
    std::istringstream list(c.options.substr(open + 1, close - open - 1));
    for (std::string item; std::getline(list, item, ',');) {
        const std::optional<double> step = realNumber(item);
        if (!step) throw UsageError(fmt::format("-c: '{}' is no number", item));
        c.steps.push_back(*step);
    }
    if (c.steps.empty()) throw UsageError("-c: {} without numbers in it");
    c.effort = c.options.substr(0, open) + "{}" + c.options.substr(close + 1);
    c.options.clear();
}

Configuration ownConfiguration(const std::string& text, size_t equals) {
    Configuration c{text.substr(0, equals), text.substr(equals + 1), "from the command line"};
    if (c.name.empty()) throw UsageError(fmt::format("-c: '{}' has no name", text));
    takeSteps(c);
    return c;
}

Configuration configurationFor(const std::string& text) {
    if (const size_t equals = text.find('='); equals != std::string::npos)
        return ownConfiguration(text, equals);
    for (const Configuration& c : knownConfigurations())
        if (c.name == text) return c;
    throw UsageError(fmt::format("-c: there is no '{}' (--list shows all there are)", text));
}

} // namespace

const std::vector<Configuration>& knownConfigurations() {
    static const std::vector<Configuration> all = {
        {"default", "", "what `render` does by itself"},
        {"independent",
         fmt::format("--sampler {} --even --branches 1 --gap-proposal off",
                     nameOf(Sampler::Independent)),
         "every path on its own, as many for each pixel: the control"},
        {"unsplit", "--branches 1", "every path with a camera ray of its own"},
        {"no-gap-proposal", "--gap-proposal off",
         "bounces go where the materials scatter, not into gaps too"},
        {"unguided", "--guiding off --portals off",
         "light samples go to an environment by its brightness alone"},
        {"guided", "--guiding on --portals off",
         "light samples learn where an environment is seen, and aim at no portals"},
        {"denoised", "--denoise on", "the picture without its noise, and the time that takes"},
        {"even", "--even", "the same number of samples for every pixel"},
        {"no-roulette", "--roulette none", "paths end at the last bounce only"},
        {"hemisphere", fmt::format("--direct {}", nameOf(DirectLight::Hemisphere)),
         "lights are found by uniform directions"},
        {"bsdf", fmt::format("--direct {}", nameOf(DirectLight::Bsdf)),
         "lights are found by bounces only"},
        {"light-samples", fmt::format("--direct {}", nameOf(DirectLight::Lights)),
         "no bounces from rough metals find lights"},
        {"mis-all", fmt::format("--direct {}", nameOf(DirectLight::MisAll)),
         "bounces from diffuse surfaces find lights too, weighted"},
        {"uniform-lights", fmt::format("--light-choice {}", nameOf(LightChoice::Uniform)),
         "of many lights any is sampled, equally often"},
        {"lights-4", "-l 4", "four light samples per shading point"},
        {"noise", "", "samples where they help most, to a stated noise", "--noise {}", kNoise},
        {"adaptive", "", "adaptive sampling, batches of 16", "-a 16 {}", kTolerances},
        {"reference", "--backend reference", "the double-precision path tracer on the CPU"},
    };
    return all;
}

std::vector<Configuration> chooseConfigurations(const std::vector<std::string>& wanted) {
    std::vector<Configuration> chosen;
    for (const std::string& text : wanted) {
        const Configuration c = configurationFor(text);
        if (std::any_of(chosen.begin(), chosen.end(),
                        [&](const Configuration& other) { return other.name == c.name; }))
            throw UsageError(fmt::format("-c: '{}' is there twice", c.name));
        chosen.push_back(c);
    }
    return chosen;
}

std::vector<std::string> splitOptions(const std::string& line) {
    std::istringstream in(line);
    std::vector<std::string> words;
    for (std::string word; in >> word;)
        words.push_back(word);
    return words;
}

std::vector<std::string> optionsAt(const Configuration& c, double step) {
    std::vector<std::string> words = splitOptions(c.options);
    if (c.effort.empty()) return words;
    for (std::string word : splitOptions(c.effort)) {
        if (const size_t at = word.find("{}"); at != std::string::npos)
            word.replace(at, 2, fmt::format("{}", step));
        words.push_back(word);
    }
    return words;
}

} // namespace stromboli::study
