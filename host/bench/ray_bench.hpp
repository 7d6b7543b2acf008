#pragma once

#include "host/bench/contestants.hpp"
#include "host/bench/device_rays.hpp"
#include "host/bench/report.hpp"

namespace stromboli::bench {

/// Traces one ray set: the device against Embree fast and robust, where there is Embree. Rays are
/// uploaded once, outside of what is measured. First, unmeasured, all say where each ray ends.
RayReport benchRays(const Arena& arena, DeviceRays& device, const EmbreePair& embree,
                    const RaySet& set);

/// Rays that one ray tracer lets end elsewhere than the other: hit against miss, or distances
/// apart by more than rounding explains. A shadow ray only hits or misses.
uint64_t countDisagreements(const RaySet& set, const std::vector<float>& a,
                            const std::vector<float>& b);

/// Of rays, by where they end.
double hitShare(const std::vector<float>& distances);

} // namespace stromboli::bench
