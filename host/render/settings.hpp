#pragma once

#include "host/film/film.hpp"
#include "host/render/estimator.hpp"
#include "scene/model/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace stromboli {

// --- Budgets -------------------------------------------------------------------------------------

/// The most samples of one pixel: its running sums count in 24-bit floats exactly up to here.
constexpr uint32_t kMostSamples = 1u << 24;

/// Adaptive sampling: pixels are tested again and again, and are finished when they pass.
struct Adaptive {
    enum class Rule {
        Neighbourhood, ///< the luminance of a pixel and its neighbours (sampling_plan.hpp)
        PerChannel,    ///< each channel of the pixel by itself
    };
    bool enabled = false;
    Rule rule = Rule::Neighbourhood;
    uint32_t batch = 32;     ///< samples between two tests of a pixel
    double tolerance = 0.05; ///< 1.96 sqrt(variance / n) <= tolerance * mean

    bool operator==(const Adaptive&) const = default;
};

/// When a render is over, apart from the number of samples. Any of these spreads the samples to
/// where they lower the picture's noise most (sampling_plan.hpp).
struct StopRule {
    double noise = 0; ///< square root of the picture's estimated relMSE, a fraction; 0: none
    double seconds =
        0; ///< of sampling; 0: no limit. The picture then depends on the machine's speed.
    bool open() const { return noise > 0 || seconds > 0; } ///< samples are not known beforehand
    bool operator==(const StopRule&) const = default;
};

/// How much of an estimate is taken, in samples, each of Estimator::branches paths.
struct Budget {
    /// No pixel gets more. Without a mean, an adaptive or a stop rule every pixel gets as many.
    uint32_t mostSamplesPerPixel = 64;
    /// Over the picture, spread to where they lower its noise most; 0: no limit.
    uint32_t meanSamplesPerPixel = 0;
    Adaptive adaptive;
    StopRule stop; ///< excludes adaptive
    /// Samples that are added up by themselves (block_backend.hpp); 0: all, one after the other.
    /// Only where every pixel gets as many.
    uint32_t samplesPerBlock = 0;

    bool spreads() const { return stop.open() || meanSamplesPerPixel > 0; }
    bool isInBlocks() const { return samplesPerBlock > 0; }
    bool operator==(const Budget&) const = default;
};

/// A budget as it is asked for: in paths, before it is known how many of them make a sample.
struct PathBudget {
    std::optional<uint32_t> mostPathsPerPixel = 64; ///< empty: no limit
    uint32_t meanPathsPerPixel = 0;                 ///< 0: no limit
    Adaptive adaptive;
    StopRule stop;
    uint32_t pathsPerBlock = 0; ///< 0: not in blocks

    bool spreads() const { return stop.open() || meanPathsPerPixel > 0; }
    /// What was asked for a pixel, on the mean or at most.
    uint32_t pathsPerPixel() const {
        return meanPathsPerPixel > 0 ? meanPathsPerPixel : mostPathsPerPixel.value_or(kMostSamples);
    }
};

/// The one place where paths become samples: of `branches` paths, which divides the counts. A block
/// is rounded down, to a sample at least.
inline Budget inSamples(const PathBudget& paths, uint32_t branches) {
    return {paths.mostPathsPerPixel ? *paths.mostPathsPerPixel / branches : kMostSamples,
            paths.meanPathsPerPixel / branches, paths.adaptive, paths.stop,
            paths.pathsPerBlock > 0 ? std::max(paths.pathsPerBlock / branches, 1u) : 0};
}

// --- Settings ------------------------------------------------------------------------------------

/// A picture of a scene, apart from the scene: which pixels, of what, how many samples. The same
/// settings, scene and device give the same bytes (unless a limit of time ends the render).
struct RenderSettings {
    PictureArea area;
    Estimator estimator;
    Budget budget;
    /// Sums that the samples of a pixel are dealt to, so that as many lanes may work at it; 0: as
    /// many as suit the device. A picture's bytes depend on it.
    uint32_t strands = 0;
};

// --- Branches ------------------------------------------------------------------------------------

/// How many branches pay in this scene (docs/theory/estimator.md, "Branches"); a divisor of the
/// number of paths a pixel is to have.
uint32_t branchesThatPay(const Scene& scene, const Estimator& estimator, const PathBudget& budget);

} // namespace stromboli
