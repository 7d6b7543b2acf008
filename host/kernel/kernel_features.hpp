#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/interface.h"

#include <array>
#include <string>
#include <vector>

namespace stromboli {

/// The specialisation constants of the path kernel, indexed by SPEC_ numbers.
using KernelFeatures = std::array<uint32_t, SPEC_COUNT>;

/// What suits a device rather than a scene.
struct DeviceTuning {
    uint32_t workgroupSize = 64;
    uint32_t traversalSteps = 8; ///< between two service passes
};

/// Switches off all that the scene and the settings do not need.
KernelFeatures kernelFeatures(const GpuScene& scene, const Camera& camera,
                              const RenderSettings& settings, const DeviceTuning& tuning);

/// The features that a kernel contains, in words, for `stromboli info`.
std::vector<std::string> describe(const KernelFeatures& features);

} // namespace stromboli
