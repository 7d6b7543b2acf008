#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

/// The inner loop on Embree. Its source is compiled for the newest instructions that Embree itself
/// is likely to run on, and must not share inline functions with the rest of the program, so this
/// interface has plain data only.
namespace stromboli::bench::native {

struct Tracer {
    RTCScene scene;
    decltype(&rtcIntersect1) intersect;
    decltype(&rtcOccluded1) occluded;
};

inline constexpr uint32_t kTriangleGeometry = 0, kSphereGeometry = 1; ///< Embree's geometry numbers

struct Totals {
    uint64_t hits = 0;
    double distances = 0;
};

/// rays: origin, tMax, direction, unused; eight floats each. distances: null, or where each ray
/// ended (the largest float for misses; shadow rays: 0 for hits).
Totals traceRays(const Tracer& tracer, bool anyHit, const float* rays, uint64_t first,
                 uint64_t count, float* distances);

/// Sets what Embree asks for in every thread that traces: denormals are zero.
void prepareThread();

} // namespace stromboli::bench::native
