#pragma once

#include "host/cli/job.hpp"
#include "host/film/brightness.hpp"
#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"

#include <optional>
#include <string>

namespace stromboli {

/// What a render did, for the closing lines and --stats.
struct RenderReport {
    std::string backend; ///< device name, or the reference
    double loadSeconds = 0, buildSeconds = 0;
    double prepareSeconds = 0; ///< the device, the kernel, the film
    double renderSeconds = 0, writeSeconds = 0;
    RenderCounters counters;
    uint64_t samplesTaken = 0, samplesAtMost = 0, samplesRejected = 0;
    /// The first sample that was rejected: its pixel, and its number there.
    std::optional<SampleName> firstRejected;
    PictureNoise noise;
    uint64_t pixelsUnreached = 0; ///< without samples
    size_t bands = 1;             ///< it was rendered in, one after the other
    bool interrupted = false;
    bool isShare = false;            ///< of a picture whose noise shows in all shares together
    std::optional<std::string> lost; ///< what the device said when it was lost for good
    std::string checkpoint;          ///< from which the render can go on; empty: there is none
    /// Nothing that was asked for is missing.
    bool complete() const { return !interrupted && !lost && pixelsUnreached == 0; }
};

/// Adds the samples and pixels of a band.
void count(const Film& film, const RenderSettings& settings, RenderReport& report);
/// The most paths that settings allow.
uint64_t mostPathsOf(const RenderSettings& settings);
/// "noise about 2 % (95 % range: 1.5 to 2.6 %)", or why it is unknown.
std::string inWords(const PictureNoise& noise);
/// With two digits that say something: 0.0234 is 2.3.
std::string percent(double share);
/// Logs time, paths, rays, Mrays/s, samples, noise, and the first rejected sample if there is one.
void logReport(const RenderReport& report, const RenderSettings& settings);
/// Says so if hardly anything can be seen in the picture, and what would help.
void logBrightness(const Brightness& brightness, const Job& job, const Options& options);
/// Throws OutputError.
void writeStatistics(const std::string& file, const RenderReport& report, const Job& job);

} // namespace stromboli
