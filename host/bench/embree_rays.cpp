// Compiled by itself, with flags of its own (CMakeLists.txt).
#include "host/bench/embree_rays.hpp"

#ifdef __SSE__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace stromboli::bench::native {
namespace {

constexpr float kLargestFloat = __FLT_MAX__;

/// Eight floats, as traceRays() takes them.
RTCRay rayOf(const float* r) {
    RTCRay ray;
    ray.org_x = r[0], ray.org_y = r[1], ray.org_z = r[2];
    ray.dir_x = r[4], ray.dir_y = r[5], ray.dir_z = r[6];
    ray.tnear = 0;
    ray.tfar = r[3];
    ray.time = 0;
    ray.mask = ~0u;
    ray.id = 0;
    ray.flags = 0;
    return ray;
}

} // namespace

Totals traceRays(const Tracer& tracer, bool anyHit, const float* rays, uint64_t first,
                 uint64_t count, float* distances) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    Totals totals;
    for (uint64_t i = first; i < first + count; ++i) {
        RTCRayHit r;
        r.ray = rayOf(rays + 8 * i);
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        float distance = kLargestFloat;
        if (anyHit) {
            tracer.occluded(tracer.scene, &context, &r.ray);
            if (r.ray.tfar < 0) distance = 0;
        } else {
            tracer.intersect(tracer.scene, &context, &r);
            if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) distance = r.ray.tfar;
        }
        const bool hit = distance < kLargestFloat;
        totals.hits += hit;
        totals.distances += hit ? double(distance) : 0.0;
        if (distances) distances[i] = distance;
    }
    return totals;
}

void prepareThread() {
#ifdef __SSE__
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
#endif
}

} // namespace stromboli::bench::native
