#pragma once

#include "host/core/text.hpp"

#include <cstdint>

namespace stromboli {

// --- Shading conventions -------------------------------------------------------------------------

/// Rules of shading by which renderers differ. The default is what physics says. Code asks for a
/// convention by its name and does not know whose it is. Those of surfaces and light that the
/// kernel's stages mind, but for the terminator offset, are rows of shaders/shared/conventions.h.
struct ShadingConventions {
    // Surfaces.

    /// Normals are turned to the side of wo. Otherwise they stay as they are stored, the flat
    /// surface reflects, and the side of the shading normal tells whether a path enters what the
    /// surface bounds.
    bool facesForward = true;
    /// If facesForward is set: light is reflected from the smooth surface that the normals describe
    /// (docs/theory/numerics.md, "Shading normals and the terminator"); otherwise from the flat
    /// triangle.
    bool offsetsTerminator = true;
    /// Light stays on the side of the geometric surface that its lobe sends it to.
    bool testsGeometricSide = true;
    /// Fresnel's equations; otherwise Schlick's approximation for glass, and one for conductors.
    bool exactFresnel = true;
    /// Smith's Lambda of the Beckmann distribution; otherwise with pi in the place of its root.
    bool exactLambda = true;
    /// Refraction multiplies radiance by the squared ratio of the indices; otherwise it divides.
    bool compressesRadiance = true;

    // Light.

    /// Light that bounces find counts wherever light samples do not account for it; otherwise only
    /// that of emissive geometry right after a delta surface, and that which `-H` finds.
    bool bouncesFindAllLight = true;
    /// Area lights fall off with the square of the distance, as the solid angle does by which they
    /// are sampled; otherwise with the distance, and they are sampled by area.
    bool inverseSquareFalloff = true;
    /// Ambient light comes from directions about the shading normal; otherwise from those with
    /// y > 0.
    bool ambientAboutNormal = true;

    // Which lights are sampled.

    /// Light samples go to emissive geometry, which stands for area lights too (scene/model
    /// area_lights.hpp). Otherwise to the lights of the file alone, of which area lights are
    /// rectangles that no ray meets.
    bool samplesEmitters = true;
    /// Each light of the file is a light by itself, even if it is dark, and is sampled at every
    /// shading point. Otherwise LightChoice says which is, of those that shine.
    bool everyLightInTurn = false;
    /// Hemisphere sampling takes Estimator::lightSamples directions for each light of the file,
    /// and delta lights bring nothing. Otherwise delta lights are sampled besides.
    bool hemispherePerLight = false;

    bool operator==(const ShadingConventions&) const = default;
};

// --- The estimator -------------------------------------------------------------------------------

enum class Integrator {
    Path,    ///< path tracing
    Normals, ///< 0.5 n + 0.5 of the interpolated shading normal at the first hit
    Depth,   ///< how far the first hit is along the camera ray
};
template <>
inline constexpr auto kNamedValues<Integrator> = std::to_array<NamedValue<Integrator>>({
    {Integrator::Path, "path", "path tracing"},
    {Integrator::Normals, "normals", "the shading normal at the first hit, as a colour"},
    {Integrator::Depth, "depth", "how far the first hit is, in metres"},
});

/// How the light that reaches a surface straight from a light is estimated
/// (docs/theory/estimator.md).
enum class DirectLight {
    Mis,        ///< sample lights; bounces find them too, weighted, where that helps
    MisAll,     ///< the same from every lobe that is no delta: the control
    Lights,     ///< sample lights
    Hemisphere, ///< sample uniform directions; delta lights as in Lights
    Bsdf,       ///< let the bounce find the lights; delta lights as in Lights
};
template <>
inline constexpr auto kNamedValues<DirectLight> = std::to_array<NamedValue<DirectLight>>({
    {DirectLight::Mis, "mis", "by sampling lights, and by bounces too where that helps"},
    {DirectLight::MisAll, "mis-all", "by both from all surfaces, also where that does not help"},
    {DirectLight::Lights, "lights", "by sampling lights alone"},
    {DirectLight::Hemisphere, "hemisphere", "by uniform directions"},
    {DirectLight::Bsdf, "bsdf", "by bounces"},
});
inline bool samplesLights(DirectLight mode) {
    return mode == DirectLight::Mis || mode == DirectLight::MisAll || mode == DirectLight::Lights;
}
/// Whether bounces may find the lights that are sampled, too.
inline bool combinesWithBounces(DirectLight mode) {
    return mode == DirectLight::Mis || mode == DirectLight::MisAll;
}

/// Where random numbers come from (docs/theory/estimator.md, "Random numbers").
enum class Sampler {
    Independent, ///< each sample on its own
    Sobol,       ///< the samples of a pixel spread evenly: less noise
};
template <>
inline constexpr auto kNamedValues<Sampler> = std::to_array<NamedValue<Sampler>>({
    {Sampler::Independent, "independent", "each sample on its own"},
    {Sampler::Sobol, "sobol", "the samples of a pixel spread evenly, less noise"},
});

/// How much a place in the picture counts for the pixels about it. Samples are spread as the filter
/// weighs them (filter importance sampling, Ernst et al. 2006), so that all weigh the same, but for
/// the sign of the filter there, and pixels stay independent of each other.
enum class PixelFilter {
    Box,
    Gaussian,       ///< standard deviation 0.5 pixels
    BlackmanHarris, ///< the four-term window (Harris 1978), 3 pixels wide
    Tent,           ///< a pyramid, 2 pixels wide
    Mitchell,       ///< cubic pieces, 4 pixels wide (Mitchell and Netravali 1988)
    CatmullRom,     ///< that of B = 0, C = 1/2: through the pixels' own values
    Lanczos,        ///< sinc, windowed by its own main lobe (Duchon 1979)
};
template <>
inline constexpr auto kNamedValues<PixelFilter> = std::to_array<NamedValue<PixelFilter>>({
    {PixelFilter::Box, "box", "the pixel's own square"},
    {PixelFilter::Gaussian, "gaussian", "standard deviation 0.5 pixels"},
    {PixelFilter::BlackmanHarris, "blackman-harris", "a bell 3 pixels wide"},
    {PixelFilter::Tent, "tent", "a pyramid 2 pixels wide"},
    {PixelFilter::Mitchell, "mitchell", "Mitchell and Netravali's, slightly negative beside"},
    {PixelFilter::CatmullRom, "catmull-rom", "sharper, more negative"},
    {PixelFilter::Lanczos, "lanczos", "of three lobes, the sharpest"},
});
/// Samples of these filters have weights, some of them negative (docs/theory/estimator.md,
/// "Camera").
inline bool hasNegativeLobes(PixelFilter filter) {
    return filter == PixelFilter::Mitchell || filter == PixelFilter::CatmullRom ||
           filter == PixelFilter::Lanczos;
}

/// The numbers of a pixel filter, where a scene file states others.
struct FilterShape {
    double width = 1;                ///< Gaussian, Tent: this times the usual one
    double b = 1.0 / 3, c = 1.0 / 3; ///< Mitchell: B and C of the paper
    uint32_t lobes = 3;              ///< Lanczos: on each side, the main one among them

    bool operator==(const FilterShape&) const = default;
};

/// How a light sample picks one of the lights (docs/theory/estimator.md, "Which light").
enum class LightChoice {
    /// What suits the lights: Tree, but Each of two, and Power in a single small mesh or where a
    /// sky
    /// outshines the others; Tree and Power by how much of each light arrives.
    Automatic,
    Tree,    ///< by what it is likely to bring to the surface
    Power,   ///< by its power
    Uniform, ///< the control
    Each,    ///< no choice: every light in turn
};
template <>
inline constexpr auto kNamedValues<LightChoice> = std::to_array<NamedValue<LightChoice>>({
    {LightChoice::Automatic, "auto", "tree, but both of two lights unless a sky and a lamp"},
    {LightChoice::Tree, "tree", "by what it is likely to bring to the surface"},
    {LightChoice::Power, "power", "by its power"},
    {LightChoice::Uniform, "uniform", "any, equally often"},
    {LightChoice::Each, "each", "none is left out: every light in turn"},
});

struct Roulette {
    enum class Mode {
        None,
        Throughput, ///< after bounce throughputStart continue with probability
                    ///< min(1, kBoldness * largest component of the throughput); kernels
                    ///< with more where it is bright (shaders/include/roulette.glsl)
        Fixed,      ///< terminate with terminationProbability at every hit, before direct light
    };
    static constexpr uint32_t kThroughputStart = 3;
    /// A path is worth going on with as long as what it may still bring is not small beside the
    /// noise the pixel has anyway: the best probability is the throughput times sqrt(second moment
    /// of the light to come / its cost) / sqrt(variance of the pixel / cost of a sample) (Bolin and
    /// Meyer 1997). Between 2 and 4 in diffuse rooms (docs/theory/estimator.md).
    static constexpr double kBoldness = 3;

    Mode mode = Mode::Throughput;
    double terminationProbability = 0; ///< Fixed: in [0, 1)
    /// Paths are at least this many bounces long under Throughput.
    uint32_t throughputStart = kThroughputStart;
};

/// What is estimated, and how: what a sample is (docs/theory/estimator.md). The same estimator,
/// scene, picture size and device give the same sample for the same pixel and number.
struct Estimator {
    uint32_t lightSamples = 1; ///< per shading point (LightChoice::Each: and area light)
    uint32_t maxBounces = 8;   ///< number of scatterings; 0: emission only
    uint32_t minBounce = 0;    ///< light scattered fewer times is left out
    Integrator integrator = Integrator::Path;
    DirectLight directLight = DirectLight::Mis;
    Sampler sampler = Sampler::Sobol;
    PixelFilter filter = PixelFilter::Box;
    FilterShape filterShape;
    LightChoice lightChoice = LightChoice::Automatic;
    uint32_t branches = 1; ///< paths of a sample, from the first surface that scatters at random on
    /// Bounces are sent into bright gaps and into shades of lamps too (docs/theory/estimator.md,
    /// "Gaps", "Aimed bounces").
    bool gapProposal = true;
    /// Light samples to an environment go where others have found it before (docs/theory/
    /// estimator.md, "Learned light samples"), not by its brightness alone.
    bool guidesLight = false;
    /// Light samples to the sky aim at windows (docs/theory/estimator.md, "Portals"); then they are
    /// not guided besides.
    bool aimsAtPortals = false;
    Roulette roulette;
    /// The most that light may bring which was scattered twice or more, by each way on which a path
    /// finds it, in its brightest channel; the rest is dropped. 0: all that it brings. Biased.
    double indirectLimit = 0;
    uint32_t seed = 0;
    bool showsBackdrop = true; ///< the camera sees the environment, where the scene has one
    ShadingConventions conventions;

    /// Light is missing by indirectLimit, so that the picture is biased.
    bool limitsLight() const { return indirectLimit > 0 && integrator == Integrator::Path; }
    /// Hemisphere sampling by the convention of that name: it counts the lights and samples none.
    bool countsLightsForHemisphere() const {
        return conventions.hemispherePerLight && directLight == DirectLight::Hemisphere;
    }
};

} // namespace stromboli
