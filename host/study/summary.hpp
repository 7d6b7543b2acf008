#pragma once

#include "host/study/estimates.hpp"
#include "host/study/study.hpp"

#include <optional>
#include <vector>

namespace stromboli::study {

enum class Clock { Wall, Cpu };

/// Over the seeds, at one effort.
struct SummaryPoint {
    double effort = 0, samples = 0;
    double wallSeconds = 0, cpuSeconds = 0; ///< medians
    Estimate relMse;                        ///< less the reference's own error
    bool limitedByReference = false;        ///< the reference's own error is the larger part
};

/// What one clock says of a configuration.
struct ClockSummary {
    std::optional<double> timeToTarget; ///< seconds, geometric mean over seeds
    bool extrapolated = false;          ///< the target is beyond the measured efforts
    std::optional<double> efficiency;   ///< 1 / (error x time) at the target error, 1 / s
    Estimate errorAtEqualTime;          ///< relMSE at the time the baseline takes to the target
    bool errorExtrapolated = false;
    /// Per seed, for ratios of configurations.
    std::vector<double> logTimeToTarget, logErrorAtEqualTime;
};

struct ConfigurationSummary {
    std::string name, options, what;
    std::vector<SummaryPoint> points;
    std::optional<Estimate> slope; ///< of log relMSE against log samples
    /// Mean of the picture over the reference's, minus 1, at the last effort all seeds have; the
    /// interval has the reference's own uncertainty in it.
    Estimate bias;
    ClockSummary wall, cpu;
    const ClockSummary& by(Clock clock) const { return clock == Clock::Wall ? wall : cpu; }
};

struct SceneSummary {
    std::string name;
    std::string baseline;
    double targetError = 0; ///< relMSE of the baseline at targetSamples
    std::vector<ConfigurationSummary> configurations;
};

SceneSummary summarise(const SceneStudy& scene, const StudySettings& settings);

/// Time of `a` over time of `b` at equal error: above 1 where b is the faster. And error of a over
/// error of b at equal time: above 1 where b has less. None where one of them has no reading.
std::optional<Estimate> timeRatio(const ConfigurationSummary& a, const ConfigurationSummary& b,
                                  Clock clock);
std::optional<Estimate> errorRatio(const ConfigurationSummary& a, const ConfigurationSummary& b,
                                   Clock clock);

} // namespace stromboli::study
