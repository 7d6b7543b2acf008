#pragma once

#include "host/film/picture_area.hpp"

#include <cstdint>

namespace stromboli {

enum class Integrator {
    Path,    ///< path tracing
    Normals, ///< 0.5 n + 0.5 of the interpolated shading normal at the first hit
};

/// How the light that reaches a surface straight from a lamp is estimated (docs/estimator.md).
enum class DirectLight {
    Mis,        ///< sample each light; bounces from rough metals find lamps too, weighted
    Lights,     ///< sample each light
    Hemisphere, ///< sample uniform directions; delta lights as in Lights
    Bsdf,       ///< let the bounce find the lamps; delta lights as in Lights
};
inline bool samplesLights(DirectLight mode) {
    return mode == DirectLight::Mis || mode == DirectLight::Lights;
}

/// Where random numbers come from (docs/estimator.md, "Random numbers").
enum class Sampler {
    Independent, ///< each sample on its own
    Sobol,       ///< the samples of a pixel spread evenly: less noise
};

/// How a sample of many emissive triangles picks one (docs/estimator.md, "Many lamps").
enum class LightChoice {
    Tree,    ///< by what it is likely to bring to the surface
    Power,   ///< by its power
    Uniform, ///< the control
};

struct Roulette {
    enum class Mode {
        None,
        Throughput, ///< after bounce kThroughputStart continue with probability
                    ///< min(kMaxContinue, kBoldness * largest component of the throughput)
        Fixed,      ///< terminate with terminationProbability at every hit, before direct light
    };
    /// Paths are at least this many bounces long under Throughput.
    static constexpr uint32_t kThroughputStart = 3;
    static constexpr double kMaxContinue = 0.95;
    /// A path is worth going on with as long as what it may still bring is not small beside the
    /// noise the pixel has anyway: the best probability is the throughput times sqrt(second moment
    /// of the light to come / its cost) / sqrt(variance of the pixel / cost of a sample) (Bolin and
    /// Meyer 1997). Between 2 and 4 in diffuse rooms (docs/estimator.md).
    static constexpr double kBoldness = 3;

    Mode mode = Mode::Throughput;
    double terminationProbability = 0; ///< Fixed: in [0, 1)
};

struct Adaptive {
    bool enabled = false;
    uint32_t batch = 32;     ///< samples between two tests of a pixel
    double tolerance = 0.05; ///< 1.96 sqrt(variance / n) <= tolerance * mean
};

/// When a render is over, apart from samplesPerPixel. Any of these spreads the samples to where
/// they lower the picture's noise most (noise_plan.hpp).
struct StopRule {
    double noise = 0; ///< square root of the picture's estimated relMSE, a fraction; 0: none
    double seconds =
        0; ///< of sampling; 0: no limit. The picture then depends on the machine's speed.
    uint32_t meanSamples = 0; ///< per pixel, over the picture; 0: no limit
    bool open() const { return noise > 0 || seconds > 0; } ///< samples are not known beforehand
    bool spreads() const { return open() || meanSamples > 0; }
};

/// What a picture is, apart from the scene. The same settings, scene and device give the same
/// bytes.
struct RenderSettings {
    uint32_t width = 800, height = 600; ///< of the whole picture, before the crop
    Crop crop;                          ///< width 0: the whole picture
    uint32_t samplesPerPixel = 64;      ///< the most a pixel gets where they are spread unevenly
    uint32_t lightSamples = 1;          ///< per shading point and area light
    uint32_t maxBounces = 8;            ///< number of scatterings; 0: emission only
    uint32_t minBounce = 0;             ///< light scattered fewer times is left out
    Integrator integrator = Integrator::Path;
    DirectLight directLight = DirectLight::Mis;
    Sampler sampler = Sampler::Sobol;
    LightChoice lightChoice = LightChoice::Tree;
    uint32_t branches = 1; ///< paths of a sample, from the first surface that scatters at random on
    bool guides = true;    ///< bounces are sent into bright gaps too (docs/estimator.md, "Gaps")
    Roulette roulette;
    Adaptive adaptive;
    StopRule stop; ///< excludes adaptive
    uint32_t seed = 0;
    bool cs184 = false; ///< shade by the CS184 renderer's conventions (docs/cs184.md)
};

} // namespace stromboli
