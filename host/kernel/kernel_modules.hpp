#pragma once

#include "host/kernel/kernel_features.hpp"

#include <cstdint>
#include <span>

namespace stromboli {

/// SPIR-V of the path kernel that has all of these features. Of several modules the smallest: a
/// driver reads all of it before specialisation constants switch anything off
/// (shaders/include/specialisation.glsl).
std::span<const uint32_t> kernelModule(const KernelFeatures& features, bool texelFetch);

/// Whether a kernel needs what RICH_MATERIALS adds: textures, attributes of corners, surfaces that
/// are partly not there, the principled BSDF and those of facets.
bool needsRichModule(const KernelFeatures& features);

} // namespace stromboli
