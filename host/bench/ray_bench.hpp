#pragma once

#include "host/bench/device_rays.hpp"
#include "host/bench/embree.hpp"
#include "host/bench/measuring.hpp"
#include "host/bench/report.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/device.hpp"

#include <cstdint>

namespace stromboli::bench {

/// Traces one ray set: the device against Embree fast and robust, where there is Embree. Rays are
/// uploaded once, outside of what is measured. First, unmeasured, all say where each ray ends.
/// layout: the tree that the device has.
RayReport benchRays(const Arena& arena, DeviceRays& device, const EmbreePair& embree,
                    const WideLayout& layout, const RaySet& set);

/// Rays that one ray tracer lets end elsewhere than the other: hit against miss, or distances
/// apart by more than rounding explains. A shadow ray only hits or misses.
uint64_t countDisagreements(const RaySet& set, const std::vector<float>& a,
                            const std::vector<float>& b);

/// The share of rays that hit something, from the distances at which they end.
double hitShare(const std::vector<float>& distances);

/// Bounce rays in the generated mesh of so many triangles in a box.
GrowthPoint benchSize(uint64_t triangles, const vulkan::Device& device, const Embree* embree,
                      uint32_t threads, const RenderSettings& settings, uint32_t raysPerPixel,
                      const AlternatePlan& plan);

/// Building: ours (and its binary tree alone) against Embree's high and medium quality, the same
/// number of threads, the scene's arrays at hand. Ours includes the layout for the device, Embree's
/// its own.
BvhReport benchBvh(const Arena& arena);

} // namespace stromboli::bench
