#pragma once

#include "host/bench/alternate.hpp"
#include "host/bench/embree.hpp"
#include "host/bench/report.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/device.hpp"

#include <cstdint>

namespace stromboli::bench {

/// Bounce rays in the generated mesh of so many triangles in a box.
GrowthPoint benchSize(uint64_t triangles, const vulkan::Device& device, const Embree* embree,
                      uint32_t threads, const RenderSettings& settings, uint32_t raysPerPixel,
                      const AlternatePlan& plan);

} // namespace stromboli::bench
