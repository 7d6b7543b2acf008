#pragma once

#include "host/render/picture_noise.hpp"
#include "host/study/configuration.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::study {

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
