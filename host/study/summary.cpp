#include "host/study/summary.hpp"

#include "host/study/journal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace stromboli::study {

namespace {

using Runs = std::vector<const Run*>;

Runs runsOf(const SceneStudy& scene, const std::string& configuration) {
    Runs runs;
    for (const Run& run : scene.runs)
        if (run.configuration == configuration && !run.points.empty()) runs.push_back(&run);
    return runs;
}

/// Errors of independent estimates add: E (x - r)^2 is the variance of x plus that of r.
double ownError(const Point& point, const Reference& reference) {
    return point.relMse - reference.relMse;
}

double timeOf(const Point& point, Clock clock) {
    return clock == Clock::Wall ? point.wallSeconds : point.cpuSeconds;
}

/// Points of a run that the reference is good enough for: their own error is the larger part.
Curve curveOf(const Run& run, const Reference& reference, auto xOf) {
    Curve curve;
    for (const Point& p : run.points)
        if (ownError(p, reference) > reference.relMse && xOf(p) > 0)
            curve.emplace_back(xOf(p), ownError(p, reference));
    std::sort(curve.begin(), curve.end());
    return curve;
}

std::vector<double> collect(const Runs& runs, size_t index, auto valueOf) {
    std::vector<double> values;
    for (const Run* run : runs)
        if (index < run->points.size()) values.push_back(valueOf(run->points[index]));
    return values;
}

size_t mostPoints(const Runs& runs) {
    size_t most = 0;
    for (const Run* run : runs)
        most = std::max(most, run->points.size());
    return most;
}

std::vector<SummaryPoint> summarisePoints(const Runs& runs, const Reference& reference) {
    std::vector<SummaryPoint> points;
    for (size_t i = 0; i < mostPoints(runs); ++i) {
        SummaryPoint p;
        p.effort = collect(runs, i, [](const Point& q) { return q.effort; }).front();
        p.samples = meanOf(collect(runs, i, [](const Point& q) { return q.samples; })).value;
        p.wallSeconds = medianOf(collect(runs, i, [](const Point& q) { return q.wallSeconds; }));
        p.cpuSeconds = medianOf(collect(runs, i, [](const Point& q) { return q.cpuSeconds; }));
        p.relMse = positiveMeanOf(
            collect(runs, i, [&](const Point& q) { return ownError(q, reference); }));
        p.limitedByReference = !(p.relMse.value > reference.relMse);
        points.push_back(p);
    }
    return points;
}

std::optional<Estimate> slopeOf(const Runs& runs, const Reference& reference) {
    std::vector<double> slopes;
    for (const Run* run : runs)
        if (const auto slope =
                logSlope(curveOf(*run, reference, [](const Point& p) { return p.samples; })))
            slopes.push_back(*slope);
    if (slopes.empty()) return std::nullopt;
    return meanOf(slopes);
}

Estimate biasOf(const Runs& runs, const Reference& reference) {
    size_t common = mostPoints(runs);
    for (const Run* run : runs)
        common = std::min(common, run->points.size());
    if (common == 0) return {};
    Estimate bias = meanOf(collect(runs, common - 1, [](const Point& p) { return p.bias; }));
    if (!bias.interval) return bias;
    const double half = std::hypot(bias.interval->second - bias.value, 1.96 * reference.meanError);
    bias.interval = std::pair(bias.value - half, bias.value + half);
    return bias;
}

/// exp of the mean.
double geometricMean(const std::vector<double>& logs) {
    return std::exp(meanOf(logs).value);
}

void readTimes(const Runs& runs, const Reference& reference, Clock clock, double target,
               ClockSummary& summary) {
    for (const Run* run : runs) {
        const Curve curve =
            curveOf(*run, reference, [&](const Point& p) { return timeOf(p, clock); });
        if (const auto time = xAt(curve, target)) {
            summary.logTimeToTarget.push_back(std::log(time->value));
            summary.extrapolated = summary.extrapolated || time->extrapolated;
        }
    }
    if (summary.logTimeToTarget.empty()) return;
    summary.timeToTarget = geometricMean(summary.logTimeToTarget);
    summary.efficiency = 1 / (target * *summary.timeToTarget);
}

void readErrors(const Runs& runs, const Reference& reference, Clock clock, double time,
                ClockSummary& summary) {
    std::vector<double> errors;
    for (const Run* run : runs) {
        const Curve curve =
            curveOf(*run, reference, [&](const Point& p) { return timeOf(p, clock); });
        if (const auto error = yAt(curve, time)) {
            errors.push_back(error->value);
            summary.logErrorAtEqualTime.push_back(std::log(error->value));
            summary.errorExtrapolated = summary.errorExtrapolated || error->extrapolated;
        }
    }
    summary.errorAtEqualTime = positiveMeanOf(errors);
}

/// Mean over seeds of the baseline's error at the target's sample count.
double targetErrorOf(const Runs& runs, const Reference& reference, double samples) {
    std::vector<double> errors;
    for (const Run* run : runs)
        if (const auto error =
                yAt(curveOf(*run, reference, [](const Point& p) { return p.samples; }), samples))
            errors.push_back(error->value);
    return errors.empty() ? 0 : meanOf(errors).value;
}

} // namespace

SceneSummary summarise(const SceneStudy& scene, const StudySettings& settings) {
    SceneSummary summary{scene.name, settings.baseline, 0, {}};
    const Runs baselineRuns = runsOf(scene, settings.baseline);
    summary.targetError =
        targetErrorOf(baselineRuns, scene.reference, double(settings.targetSamples));
    for (const Configuration& c : settings.configurations) {
        const Runs runs = runsOf(scene, c.name);
        if (runs.empty()) continue;
        ConfigurationSummary s;
        s.name = c.name;
        s.options = c.options + (c.options.empty() || c.effort.empty() ? "" : " ") + c.effort;
        s.what = c.what;
        s.points = summarisePoints(runs, scene.reference);
        s.slope = slopeOf(runs, scene.reference);
        s.bias = biasOf(runs, scene.reference);
        for (const Clock clock : {Clock::Wall, Clock::Cpu}) {
            ClockSummary& by = clock == Clock::Wall ? s.wall : s.cpu;
            if (!(summary.targetError > 0)) continue;
            ClockSummary baseline;
            readTimes(baselineRuns, scene.reference, clock, summary.targetError, baseline);
            readTimes(runs, scene.reference, clock, summary.targetError, by);
            if (baseline.timeToTarget)
                readErrors(runs, scene.reference, clock, *baseline.timeToTarget, by);
        }
        summary.configurations.push_back(s);
    }
    return summary;
}

std::optional<Estimate> timeRatio(const ConfigurationSummary& a, const ConfigurationSummary& b,
                                  Clock clock) {
    const auto &logA = a.by(clock).logTimeToTarget, &logB = b.by(clock).logTimeToTarget;
    if (logA.empty() || logB.empty()) return std::nullopt;
    return ratioOf(logA, logB);
}

std::optional<Estimate> errorRatio(const ConfigurationSummary& a, const ConfigurationSummary& b,
                                   Clock clock) {
    const auto &logA = a.by(clock).logErrorAtEqualTime, &logB = b.by(clock).logErrorAtEqualTime;
    if (logA.empty() || logB.empty()) return std::nullopt;
    return ratioOf(logA, logB);
}

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
