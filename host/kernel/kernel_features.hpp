#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/estimator.hpp"
#include "host/render/layers.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/interface.h"

#include <array>
#include <string>
#include <vector>

namespace stromboli {

/// The specialisation constants of the path kernel, indexed by SPEC_ numbers.
using KernelFeatures = std::array<uint32_t, SPEC_COUNT>;

/// Switches off all that the scene and the settings do not need; with tuning.everythingOn only
/// what the settings do not need. Throws std::invalid_argument for conventions of light that
/// the kernel does not follow together: bouncesFindAllLight where light is sampled by other
/// conventions than the default's, rectangles (samplesEmitters is not set) without
/// everyLightInTurn, and emissive geometry without inverseSquareFalloff.
KernelFeatures kernelFeatures(const GpuScene& scene, const Camera& camera,
                              const Estimator& settings, const DeviceTuning& tuning);

/// Those of the kernel that sees: camera rays of these settings, and nothing of light or media.
KernelFeatures seeingFeatures(const GpuScene& scene, const Camera& camera,
                              const Estimator& settings, const DeviceTuning& tuning, Seeing what);

/// Whether some bounces of these settings may go where lamps make it bright.
bool mayAimBounces(const Estimator& settings);
/// Whether they go to the scene's lit cells.
bool aimsBounces(const GpuScene& scene, const Estimator& settings);

/// Whether rays of light samples go on where they meet clear glass, and whether they might if
/// enough light came that way (GpuScene::glassBeforeLights).
bool lightsThroughGlass(const GpuScene& scene, const Estimator& settings);
bool mayLightThroughGlass(const GpuScene& scene, const Estimator& settings);
/// Whether light samples of these settings go to an environment, and shall be guided; and whether
/// they are, where no portals are aimed at.
bool mayGuideLight(const GpuScene& scene, const Estimator& settings);
bool guidesLight(const GpuScene& scene, const Estimator& settings);
/// Whether light samples of these settings go to the sky, and shall aim at the scene's portals.
bool aimsAtPortals(const GpuScene& scene, const Estimator& settings);

/// Whether light samples of these settings may be stopped by occluders; and how many a kernel looks
/// at: all that there may be, or none, so that kernels are shared.
bool mayLookAtOccluders(const GpuScene& scene, const Estimator& settings);
uint32_t occludersLookedAt(const GpuScene& scene, const Estimator& settings);
/// Whether light samples of these settings may be stopped by a shadow map; and whether they are.
bool mayLookAtShadowMap(const GpuScene& scene, const Estimator& settings);
bool looksAtShadowMap(const GpuScene& scene, const Estimator& settings);

/// Those of the kernel that records the path of a sample as it takes it.
KernelFeatures recordingFeatures(const GpuScene& scene, const Camera& camera,
                                 const Estimator& settings, const DeviceTuning& tuning);

/// The rules that do not hold, as bits of CONVENTION_LIST (shaders/shared/conventions.h).
uint32_t departures(const ShadingConventions& conventions);

/// The LIGHT_CHOICE_ that a kernel for these lights has.
uint32_t lightChoiceConstant(const LightTable& lights);

/// How the value of a feature reads.
struct FeatureValue {
    enum class Kind {
        Flag,   ///< on or off
        Bits,   ///< a set: bit n stands for names[n]
        Choice, ///< n stands for names[n]
        Count,  ///< a number of names[0]
        Share,  ///< a float, in percent
        Number, ///< a float
    };
    Kind kind;
    std::vector<const char*> names;
};

/// A row of the table of features (shaders/shared/features.h).
struct Feature {
    KernelConstant constant;
    const char* name;
    const char* label; ///< of its line of `stromboli info`
    FeatureValue shown;
    const char* adds; ///< to the kernel
};

/// In the order of the table.
const std::vector<Feature>& featureTable();

/// In words; a flag that is on has none, and what is off "none".
std::string valueText(const Feature& feature, uint32_t value);

/// The features that a kernel has, a line each, for `stromboli info`.
std::vector<std::string> describe(const KernelFeatures& features);

} // namespace stromboli
