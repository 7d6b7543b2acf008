#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/report.hpp"
#include "host/kernel/kernel_tuning.hpp"

namespace stromboli::bench {

/// Whole paths by the kernel that renders use. A measurement takes samplesPerPixel more samples of
/// every pixel, film and all; what the scene needs on the device is there already.
PathReport benchPaths(const Arena& arena, const GpuScene& gpu);

/// A form of the kernel to compare with the default one.
struct KernelVariant {
    std::string name;
    KernelTuning tuning;
};

/// The forms that are of interest: with all features left in.
std::vector<KernelVariant> kernelVariants(const GpuScene& scene);

/// ourName: of the kernel that renders use.
VariantReport benchVariants(const Arena& arena, const GpuScene& gpu,
                            const std::vector<KernelVariant>& variants,
                            const std::string& ourName = "specialised");

} // namespace stromboli::bench
