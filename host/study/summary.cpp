#include "host/study/summary.hpp"

#include <algorithm>
#include <cmath>

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

} // namespace stromboli::study
