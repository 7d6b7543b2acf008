#include "host/study/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace stromboli::study {
namespace {

std::string interval(const Estimate& e, const char* format, double scale = 1) {
    std::string text = fmt::format(fmt::runtime(format), scale * e.value);
    if (e.interval)
        text += fmt::format(fmt::runtime(fmt::format(" ({0}..{0})", format)),
                            scale * e.interval->first, scale * e.interval->second);
    return text;
}

/// The baseline is what it is compared with: no uncertainty is in that.
std::string ratio(const std::optional<Estimate>& e, const ConfigurationSummary& c,
                  const SceneSummary& s) {
    if (c.name == s.baseline) return "1";
    return e ? interval(*e, "{:.2f}") : "-";
}

std::string seconds(const ClockSummary& s) {
    if (!s.timeToTarget) return "-";
    return fmt::format("{:.3g} s{}", *s.timeToTarget, s.extrapolated ? " *" : "");
}

const ConfigurationSummary* find(const SceneSummary& s, const std::string& name) {
    for (const ConfigurationSummary& c : s.configurations)
        if (c.name == name) return &c;
    return nullptr;
}

std::string tableOf(const SceneStudy& scene, const SceneSummary& s, Clock clock) {
    std::string text = fmt::format("\n{}, {} x {}; reference of {} samples, its own relMSE {:.2e}\n"
                                   "target: relMSE {:.4g}, that of '{}'; {} time; 95 % intervals\n"
                                   "{:<14} {:>24} {:>12} {:>20} {:>20} {:>24}\n",
                                   scene.name, scene.width, scene.height, scene.reference.samples,
                                   scene.reference.relMse, s.targetError, s.baseline,
                                   clock == Clock::Cpu ? "CPU" : "wall", "", "slope", "to target",
                                   "speed-up", "times less error", "bias %");
    const ConfigurationSummary* baseline = find(s, s.baseline);
    bool extrapolated = false;
    for (const ConfigurationSummary& c : s.configurations) {
        extrapolated = extrapolated || c.by(clock).extrapolated;
        text += fmt::format("{:<14} {:>24} {:>12} {:>20} {:>20} {:>24}\n", c.name,
                            c.slope ? interval(*c.slope, "{:.2f}") : "-", seconds(c.by(clock)),
                            baseline ? ratio(timeRatio(*baseline, c, clock), c, s) : "-",
                            baseline ? ratio(errorRatio(*baseline, c, clock), c, s) : "-",
                            interval(c.bias, "{:.3f}", 100));
    }
    if (extrapolated) text += "* beyond the efforts measured\n";
    return text;
}

/// The pictures of a configuration and an effort whose render stated a noise, and what it was
/// worth.
struct StatedNoise {
    double effort = 0;
    int pictures = 0, stated = 0, held = 0;
    double logRatio = 0; ///< sum of log (stated / true)

    void add(const Point& p, double referenceError) {
        ++pictures;
        const double truth = std::sqrt(std::max(p.relMse - referenceError, 0.0));
        if (!p.noise.known() || truth == 0) return;
        ++stated;
        held += truth >= p.noise.least && truth <= p.noise.most ? 1 : 0;
        logRatio += std::log(std::max(p.noise.estimate, 1e-300) / truth);
    }
};

std::string statedNoiseOf(const SceneStudy& scene) {
    std::map<std::string, std::map<double, StatedNoise>> table;
    bool any = false;
    for (const Run& run : scene.runs)
        for (const Point& p : run.points) {
            StatedNoise& stated = table[run.configuration][p.effort];
            stated.effort = p.effort;
            stated.add(p, scene.reference.relMse);
            any = any || stated.stated > 0;
        }
    if (!any) return "";
    std::string text = fmt::format("stated noise: how often its 95 % range holds the true one\n"
                                   "{:<14} {:>10} {:>10} {:>10} {:>10} {:>14}\n",
                                   "", "effort", "pictures", "stated", "held", "stated / true");
    for (const auto& [name, efforts] : table)
        for (const auto& [effort, n] : efforts)
            text += fmt::format(
                "{:<14} {:>10} {:>10} {:>10} {:>10} {:>14}\n", name, effort, n.pictures, n.stated,
                n.held,
                n.stated > 0 ? fmt::format("{:.2f}", std::exp(n.logRatio / n.stated)) : "-");
    return text;
}

} // namespace

std::string toText(const Study& study) {
    std::string text;
    for (const SceneStudy& scene : study.scenes)
        if (!scene.runs.empty())
            text += tableOf(scene, summarise(scene, study.settings),
                            study.deviceIsCpu ? Clock::Cpu : Clock::Wall) +
                    statedNoiseOf(scene);
    return text;
}

} // namespace stromboli::study
