// Compiled with flags of its own (CMakeLists.txt). All in it is internal but for the functions of
// its header: an inline function that other files have too could be linked from here, with
// instructions that the rest of the program must not need.
#include "host/bench/embree_kernel.hpp"

#include "host/bench/embree_kernel_lights.hpp"
#include "host/bench/embree_kernel_random.hpp"

#ifdef __SSE__
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

namespace stromboli::bench::native {
namespace {

void setRay(RTCRay& r, Vec origin, Vec direction, float tNear, float tFar) {
    r.org_x = origin[0];
    r.org_y = origin[1];
    r.org_z = origin[2];
    r.tnear = tNear;
    r.dir_x = direction[0];
    r.dir_y = direction[1];
    r.dir_z = direction[2];
    r.time = 0;
    r.tfar = tFar;
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
}

/// Takes one sample of a pixel. The random numbers are those of the kernel, so that the pictures
/// agree but for rounding.
template <uint32_t features>
class PathSample {
  public:
    PathSample(const World& world, uint32_t pixel, uint32_t sample)
        : w_(world), pixel_(pixel), sample_(sample) {
        rtcInitIntersectContext(&context_);
    }

    Vec radiance() {
        Random u = random(0);
        if (!traceCamera({u.z, u.w})) return radiance_; // ambient light is not a backdrop
        bool countsEmission = w_.minBounce == 0;
        for (uint32_t bounce = 1;; ++bounce) {
            if (countsEmission) radiance_ = radiance_ + throughput_ * emission(point_);
            if (bounce > w_.maxBounces) break;
            if (w_.roulette == Roulette::Fixed) {
                if (u.leftOver < w_.terminationProbability) break;
                throughput_ = throughput_ * (1 / (1 - w_.terminationProbability));
            }
            const bool delta = hasDelta && isDelta(*point_.surface);
            const uint32_t blocks = 1 + w_.lightSamples;
            if (!delta && bounce >= w_.minBounce) addDirectLight((bounce - 1) * blocks, u);

            u = random(bounce * blocks);
            const Bounce next = scatter<hasDelta>(point_, {u.z, u.w});
            throughput_ = throughput_ * next.weight;
            if (!survives(bounce, u.leftOver)) break;
            countsEmission = delta && bounce >= w_.minBounce;
            const float ofSky = countsEmission ? 1 : skyOfBounce(bounce);
            if (bounce == w_.maxBounces && !countsEmission && ofSky == 0) break;
            if (trace(leave(point_, next.direction), next.direction, 0, kLargestFloat)) continue;
            if (otherLights && ofSky > 0)
                radiance_ = radiance_ + throughput_ * ofSky * ambientRadiance(w_, next.direction);
            break;
        }
        return radiance_;
    }

    uint32_t rays() const { return rays_; }

  private:
    static constexpr bool hasSpheres = features & kHasSpheres;
    static constexpr bool hasNormals = features & kHasNormals;
    static constexpr bool hasDelta = features & kHasDeltaSurfaces;
    static constexpr bool otherLights = features & kHasOtherLights;

    Random random(uint32_t block) const {
        return w_.sobol ? sobolBlock(pixel_, sample_, block, w_.seed)
                        : randomBlock(pixel_, sample_, block, w_.seed);
    }

    bool traceCamera(Random2 u) {
        const View& view = w_.view;
        const float s = (float(pixel_ % w_.width) + u.x) / float(w_.width);
        const float t = (float(pixel_ / w_.width) + u.y) / float(w_.height);
        const Vec across = (2 * s - 1) * vec(view.right) + (1 - 2 * t) * vec(view.up);
        Vec origin = vec(view.position), direction = -vec(view.back);
        float alongAxis = 1; // length of the ray per unit of depth
        if (view.orthographic) {
            origin = origin + across;
        } else {
            const Vec d = across - vec(view.back);
            const float length = std::sqrt(dot(d, d));
            direction = d * (1 / length);
            if (!view.clipAlongRay) alongAxis = length;
        }
        return trace(origin, direction, view.nearDistance * alongAxis,
                     smaller(view.farDistance * alongAxis, kLargestFloat));
    }

    /// Traces a path ray and, if it hits, makes that point the current one.
    bool trace(Vec origin, Vec direction, float tNear, float tFar) {
        ++rays_;
        RTCRayHit r;
        setRay(r.ray, origin, direction, tNear, tFar);
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        w_.tracer.intersect(w_.tracer.scene, &context_, &r);
        if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        point_ = hasSpheres && r.hit.geomID == kSphereGeometry
                     ? sphereAt(w_, r, origin, direction)
                     : triangleAt<hasNormals>(w_, r, origin, direction);
        return true;
    }

    bool isFree(const LightSample& light) {
        ++rays_;
        const Vec origin = leave(point_, light.direction);
        RTCRay r;
        if (light.infinite)
            setRay(r, origin, light.direction, 0, kLargestFloat);
        else
            setRay(r, origin, light.target - origin, 0, 1);
        w_.tracer.occluded(w_.tracer.scene, &context_, &r);
        return r.tfar >= 0; // minus infinity where something is in the way
    }

    void addLight(uint32_t index, Random2 u) {
        const PickedLight picked =
            otherLights ? pickLight(w_, point_, index, u) : PickedLight{w_.lightEntries, 1, u};
        if (!(picked.probability > 0)) return;
        const LightSample s = sampleLight<otherLights>(w_, point_, *picked.entry, picked.u);
        // Where bounces have a part of the sky and light samples too, there is no other light.
        const float ofLights = w_.ambientOfBounces < 1 ? 1 - w_.ambientOfBounces : 1;
        const Vec value = evaluate(point_, s.direction) * s.radiance *
                          (ofLights * lightSampleShare(w_, index) / picked.probability);
        if (isLit(value) && isFree(s)) radiance_ = radiance_ + throughput_ * value;
    }

    /// block: that of the ray that came here, its numbers u.
    void addDirectLight(uint32_t block, const Random& u) {
        for (uint32_t i = 0; i < w_.lightSamples; ++i) {
            const Random own = i == 0 ? u : random(block + 1 + i);
            addLight(i, {own.x, own.y});
        }
    }

    /// The share of the ambient light that a bounce from a diffuse surface finds.
    float skyOfBounce(uint32_t bounce) const {
        return otherLights && bounce >= w_.minBounce ? w_.ambientOfBounces : 0;
    }

    bool survives(uint32_t bounce, float u) {
        const float most = largest(throughput_);
        if (!(most > 0)) return false;
        if (w_.roulette != Roulette::Throughput || bounce < kRouletteStart) return true;
        const float q = smaller(kMostContinue, kBoldness * most);
        throughput_ = throughput_ * (1 / q);
        return u < q;
    }

    const World& w_;
    uint32_t pixel_, sample_, rays_ = 0;
    RTCIntersectContext context_;
    Vec throughput_ = vec(1), radiance_ = vec(0);
    Point point_;
};

/// A sample the kernel would leave out too (shaders/include/accumulate.glsl).
bool isValid(Vec v) {
    constexpr float most = 0x1p48f;
    return v[0] >= 0 && v[1] >= 0 && v[2] >= 0 && v[0] <= most && v[1] <= most && v[2] <= most;
}

template <uint32_t features>
PixelSums takeSamples(const World& world, uint32_t pixel, uint32_t first, uint32_t count) {
    PixelSums sums{};
    for (uint32_t i = 0; i < count; ++i) {
        PathSample<features> path(world, pixel, first + i);
        const Vec value = path.radiance();
        sums.rays += path.rays();
        if (!isValid(value)) {
            if (sums.rejected++ == 0) sums.firstRejected = i;
            continue;
        }
        ++sums.count;
        for (int c = 0; c < 3; ++c) {
            sums.sum[c] += double(value[c]);
            sums.squares[c] += double(value[c]) * double(value[c]);
        }
    }
    return sums;
}

using Take = PixelSums (*)(const World&, uint32_t, uint32_t, uint32_t);
constexpr Take kTake[kFeatureSets] = {
    takeSamples<0>,  takeSamples<1>,  takeSamples<2>,  takeSamples<3>,
    takeSamples<4>,  takeSamples<5>,  takeSamples<6>,  takeSamples<7>,
    takeSamples<8>,  takeSamples<9>,  takeSamples<10>, takeSamples<11>,
    takeSamples<12>, takeSamples<13>, takeSamples<14>, takeSamples<15>};

} // namespace

PixelSums samplePixel(const World& world, uint32_t features, uint32_t pixel, uint32_t first,
                      uint32_t count) {
    return kTake[features](world, pixel, first, count);
}

Totals traceRays(const Tracer& tracer, bool anyHit, const float* rays, uint64_t first,
                 uint64_t count, float* distances) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    Totals totals;
    for (uint64_t i = first; i < first + count; ++i) {
        const float* ray = rays + 8 * i;
        RTCRayHit r;
        setRay(r.ray, vec(ray[0], ray[1], ray[2]), vec(ray[4], ray[5], ray[6]), 0, ray[3]);
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
