#pragma once

#include "host/study/study.hpp"

#include <cmath>

namespace stromboli::study {

/// A run whose error is `scale` samples^slope (plus that of the reference) and whose sampling
/// takes `secondsPerSample`, twice that in CPU time.
inline Run powerLawRun(const std::string& name, uint32_t seed, double scale, double slope,
                       double secondsPerSample, double referenceError,
                       const std::vector<uint32_t>& counts) {
    Run run{name, seed, {}, false};
    for (const uint32_t samples : counts) {
        Point p;
        p.effort = p.samples = samples;
        p.wallSeconds = secondsPerSample * samples;
        p.cpuSeconds = 2 * p.wallSeconds;
        p.relMse = scale * std::pow(samples, slope) + referenceError;
        p.bias = seed % 2 ? 0.01 : 0.03;
        run.points.push_back(p);
    }
    return run;
}

/// "default": error 1 / n at 0.1 s a sample; "hemisphere": 8 / n at 0.05 s; "bsdf": n^-1.5 at 0.1.
inline Study powerLawStudy(uint32_t seeds, double referenceError) {
    Study study;
    study.settings.configurations = chooseConfigurations({"default", "hemisphere", "bsdf"});
    study.settings.seeds = seeds;
    study.settings.sampleCounts = {4, 16, 64, 256};
    study.settings.baseline = "default";
    study.settings.targetSamples = 64;
    study.key = "test";
    SceneStudy scene;
    scene.name = "s";
    scene.width = scene.height = 8;
    scene.reference.relMse = referenceError;
    scene.reference.meanError = 0.001;
    for (uint32_t seed = 1; seed <= seeds; ++seed) {
        const auto& n = study.settings.sampleCounts;
        scene.runs.push_back(powerLawRun("default", seed, 1, -1, 0.1, referenceError, n));
        scene.runs.push_back(powerLawRun("hemisphere", seed, 8, -1, 0.05, referenceError, n));
        scene.runs.push_back(powerLawRun("bsdf", seed, 1, -1.5, 0.1, referenceError, n));
    }
    study.scenes.push_back(scene);
    return study;
}

} // namespace stromboli::study
