#pragma once

#include "host/kernel/kernel_features.hpp"

#include <cstdint>

namespace stromboli {

/// 32-bit words that a scheduler keeps of a path in memory (shaders/shared/path_fields.h), in
/// kernels with these features.
uint32_t pathWords(const KernelFeatures& features, PathScheduler scheduler);

} // namespace stromboli
