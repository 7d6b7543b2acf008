#pragma once

#include "host/cli/job.hpp"
#include "host/film/film.hpp"
#include "host/render/backend.hpp"

#include <string>

namespace stromboli {

/// What a render did, for the closing lines and --stats.
struct RenderReport {
    std::string backend; ///< device name, or the reference
    double loadSeconds = 0, buildSeconds = 0, renderSeconds = 0;
    RenderCounters counters;
    uint64_t samplesTaken = 0, samplesAtMost = 0, samplesRejected = 0;
    double noise = 0; ///< square root of the estimated relMSE
    bool complete = true;
};

RenderReport summarise(const Film& film, const RenderSettings& settings);
/// Logs time, paths, rays, Mrays/s, samples, noise, and the first rejected sample if there is one.
void logReport(const RenderReport& report, const Film& film, const RenderSettings& settings);
/// Throws OutputError.
void writeStatistics(const std::string& file, const RenderReport& report, const Job& job);

} // namespace stromboli
