#pragma once

#include "host/render/picture_noise.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::study {

// --- Configurations ------------------------------------------------------------------------------

/// A way to render, by name: options of `stromboli render` on top of its defaults.
struct Configuration {
    std::string name;
    std::string options; ///< as on a command line
    std::string what;    ///< one line for the report
    /// Empty: effort is the sample count. Otherwise an option with {} for a number, and the numbers
    /// in order of growing effort: each is a render of its own, as of a tolerance.
    std::string effort = {};
    std::vector<double> steps = {};
};

/// Every configuration that `study` knows; to add one, add a line to the table.
const std::vector<Configuration>& knownConfigurations();

/// A list of names, and of "NAME=OPTIONS" for configurations of one's own; an option in it that
/// holds {a,b,...} is the effort, its steps a, b, ... . Throws UsageError for an unknown name or
/// one that is there twice.
std::vector<Configuration> chooseConfigurations(const std::vector<std::string>& wanted);

/// An option line at white space; no quoting.
std::vector<std::string> splitOptions(const std::string& line);

/// The options of a configuration at one step; `step` is ignored if the effort is samples.
std::vector<std::string> optionsAt(const Configuration& configuration, double step);

// --- The study -----------------------------------------------------------------------------------

struct StudySettings {
    std::vector<std::string> scenes;
    std::vector<Configuration> configurations;
    std::string commonOptions;                             ///< for every render: size, bounces, ...
    std::string referenceOptions;                          ///< on top of them, for the reference
    std::vector<uint32_t> sampleCounts = {4, 16, 64, 256}; ///< growing
    uint32_t seeds = 4; ///< runs of each configuration have the seeds 1, 2, ...
    uint32_t referenceSamples = 4096;
    double mostSecondsPerRun = 120; ///< wall time; steps that would take longer are left out
    uint32_t targetSamples = 64;    ///< the error that times are compared at is the baseline's here
    std::string baseline;           ///< name of a configuration
};

/// No run has this seed.
inline constexpr uint32_t kReferenceSeed = 0x5EED0000u;

/// A picture of one effort.
struct Point {
    double effort = 0;                      ///< samples asked for, or the step
    double samples = 0;                     ///< mean samples taken a pixel
    double wallSeconds = 0, cpuSeconds = 0; ///< of sampling alone
    double relMse = 0, mse = 0;             ///< against the reference, whose own error is in them
    double bias = 0;                        ///< mean of the picture over the reference's, minus 1
    uint64_t rays = 0, rejected = 0;
    PictureNoise noise; ///< as the render states it; unknown where samples grow within one render
};

/// One configuration with one seed: growing efforts.
struct Run {
    std::string configuration;
    uint32_t seed = 0;
    std::vector<Point> points;
    bool cutShort = false; ///< by mostSecondsPerRun
};

struct Reference {
    std::string file; ///< in the study's folder
    std::string options;
    uint32_t samples = 0;
    double seconds = 0;   ///< wall time of making it
    double relMse = 0;    ///< its own error, from its pixels' variances
    double meanError = 0; ///< standard error of the picture's mean over that mean
};

struct SceneStudy {
    std::string name;
    std::string content; ///< checksum of its file: another scene has another reference
    uint32_t width = 0, height = 0;
    Reference reference;
    std::vector<Run> runs;
};

/// Everything measured, as it is kept in study.json.
struct Study {
    /// What has to be the same for runs to be comparable: program, device, common options, ... .
    std::string key;
    std::map<std::string, std::string> circumstances; ///< "device", "driver", "cpu", "command", ...
    bool deviceIsCpu = false;
    StudySettings settings;
    std::vector<SceneStudy> scenes;
};

} // namespace stromboli::study
