#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/estimator.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/interface.h"

#include <array>
#include <string>
#include <vector>

namespace stromboli {

/// The specialisation constants of the path kernel, indexed by SPEC_ numbers.
using KernelFeatures = std::array<uint32_t, SPEC_COUNT>;

/// Switches off all that the scene and the settings do not need; with tuning.everythingOn only
/// what the settings do not need. Throws std::invalid_argument for shading conventions that are
/// neither the default nor cs184Shading(): the shaders have no mixture of the two.
KernelFeatures kernelFeatures(const GpuScene& scene, const Camera& camera,
                              const Estimator& settings, const DeviceTuning& tuning);

/// The LIGHT_CHOICE_ that a kernel for these lights has.
uint32_t lightChoiceConstant(const LightTable& lights);

/// The features that a kernel contains, in words, for `stromboli info`.
std::vector<std::string> describe(const KernelFeatures& features);

} // namespace stromboli
