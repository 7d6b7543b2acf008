#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/report.hpp"
#include "host/kernel/kernel_tuning.hpp"

namespace stromboli::bench {

/// Whole paths: the kernel that renders use against the path tracer on Embree, fast and robust. A
/// measurement takes samplesPerPixel more samples of every pixel, film and all; what the scene
/// needs on the device is there already. The contestants have the same random numbers, so their
/// pictures are compared sample for sample.
PathReport benchPaths(const Arena& arena, const GpuScene& gpu, const EmbreePair& embree);

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
