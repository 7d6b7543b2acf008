#include "host/bench/embree.hpp"

#include "host/bench/embree_rays.hpp"
#include "host/bench/measuring.hpp"
#include "host/core/error.hpp"
#include "host/core/system.hpp"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <string>

namespace stromboli::bench {
namespace {

/// Embree's functions, found in its shared library when they are first wanted: linked with the
/// program, the library would add 3 ms to every start of it.
struct EmbreeApi {
#define STROMBOLI_EMBREE_FUNCTIONS(apply)                                                          \
    apply(rtcNewDevice) apply(rtcReleaseDevice) apply(rtcGetDeviceError)                           \
        apply(rtcGetDeviceProperty) apply(rtcSetDeviceMemoryMonitorFunction) apply(rtcNewScene)    \
            apply(rtcReleaseScene) apply(rtcSetSceneFlags) apply(rtcSetSceneBuildQuality)          \
                apply(rtcCommitScene) apply(rtcNewGeometry) apply(rtcReleaseGeometry)              \
                    apply(rtcSetGeometryBuildQuality) apply(rtcSetSharedGeometryBuffer)            \
                        apply(rtcCommitGeometry) apply(rtcAttachGeometryByID) apply(rtcIntersect1) \
                            apply(rtcOccluded1) apply(rtcSetGeometryInstancedScene)                \
                                apply(rtcSetGeometryTransform) apply(rtcAttachGeometry)
#define STROMBOLI_EMBREE_POINTER(name) decltype(&::name) name = nullptr;
    STROMBOLI_EMBREE_FUNCTIONS(STROMBOLI_EMBREE_POINTER)
#undef STROMBOLI_EMBREE_POINTER

    std::string missing; ///< why Embree cannot be used; empty: it can
};

EmbreeApi load() {
    EmbreeApi api;
    SharedLibrary library("libembree3.so.3", "libembree3-3");
#define STROMBOLI_EMBREE_FIND(name) library.find(api.name, #name);
    STROMBOLI_EMBREE_FUNCTIONS(STROMBOLI_EMBREE_FIND)
#undef STROMBOLI_EMBREE_FIND
    api.missing = library.missing();
    return api;
}

/// Loaded at the first call and never unloaded.
const EmbreeApi& embreeApi() {
    static const EmbreeApi api = load();
    return api;
}

constexpr uint64_t kRayBlock = 1024; ///< rays a thread takes at a time

/// A device, and how much memory its acceleration structures take.
class Device {
  public:
    explicit Device(uint32_t threads)
        : handle_(embreeApi().rtcNewDevice(fmt::format("threads={}", threads).c_str())),
          threads_(threads) {
        check("start");
        embreeApi().rtcSetDeviceMemoryMonitorFunction(handle_, count, &bytes_);
    }
    ~Device() { embreeApi().rtcReleaseDevice(handle_); }
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    RTCDevice handle() const { return handle_; }
    uint32_t threads() const { return threads_; }
    int64_t bytes() const { return bytes_; }

    /// Throws DeviceError if a call since the last check failed.
    void check(const char* what) const {
        const RTCError error = embreeApi().rtcGetDeviceError(handle_);
        if (error == RTC_ERROR_NONE) return;
        const char* why = error == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "error";
        throw DeviceError(fmt::format("Embree could not {}: {} {}", what, why, int(error)));
    }

  private:
    static bool count(void* total, ssize_t bytes, bool) {
        *static_cast<std::atomic<int64_t>*>(total) += bytes;
        return true;
    }

    std::atomic<int64_t> bytes_{0};
    RTCDevice handle_;
    uint32_t threads_;
};

struct Arrays final : EmbreeGeometry {
    std::vector<glm::vec3> positions; ///< and one more: Embree reads 16 bytes of each
    std::vector<uint32_t> indices;
    std::vector<glm::vec4> spheres; ///< centre, radius
    uint32_t firstInWorld;          ///< triangle; those of prototypes come before
    std::vector<Prototype> prototypes;
    std::vector<Placement> placements;

    explicit Arrays(const Scene& scene)
        : positions(scene.positions), firstInWorld(scene.firstInWorld()),
          prototypes(scene.prototypes), placements(scene.placements) {
        positions.emplace_back(0.0f);
        for (const Triangle& t : scene.triangles)
            indices.insert(indices.end(), {t.corner[0], t.corner[1], t.corner[2]});
        for (const Sphere& s : scene.spheres)
            spheres.emplace_back(s.center, s.radius);
    }
};

class BuiltScene final : public EmbreeScene {
  public:
    BuiltScene(std::shared_ptr<const Device> device, std::shared_ptr<const Arrays> arrays,
               EmbreeMode mode, EmbreeQuality quality)
        : device_(std::move(device)), arrays_(std::move(arrays)),
          scene_(embreeApi().rtcNewScene(device_->handle())) {
        const EmbreeApi& api = embreeApi();
        const RTCBuildQuality build =
            quality == EmbreeQuality::High ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
        const int64_t before = device_->bytes();
        const Stopwatch watch;
        configure(scene_, mode, build);
        const auto triangleCount = uint32_t(arrays_->indices.size() / 3) - arrays_->firstInWorld;
        if (triangleCount > 0)
            attach(scene_, triangles(arrays_->firstInWorld, triangleCount),
                   native::kTriangleGeometry, build);
        if (!arrays_->spheres.empty()) attach(scene_, spheres(), native::kSphereGeometry, build);
        attachPlacements(mode, build);
        api.rtcCommitScene(scene_);
        buildSeconds = watch.seconds();
        bytes = uint64_t(std::max<int64_t>(device_->bytes() - before, 0));
        device_->check("build a scene");
    }
    ~BuiltScene() override {
        embreeApi().rtcReleaseScene(scene_);
        for (const RTCScene prototype : prototypes_)
            embreeApi().rtcReleaseScene(prototype);
    }
    BuiltScene(const BuiltScene&) = delete;
    BuiltScene& operator=(const BuiltScene&) = delete;

    RayTotals trace(const RaySet& set) const override { return run(set, nullptr); }

    std::vector<float> distances(const RaySet& set) const override {
        std::vector<float> result(set.rays.size());
        run(set, result.data());
        return result;
    }

  private:
    static void configure(RTCScene scene, EmbreeMode mode, RTCBuildQuality build) {
        const EmbreeApi& api = embreeApi();
        api.rtcSetSceneFlags(scene, mode == EmbreeMode::Robust ? RTC_SCENE_FLAG_ROBUST
                                                               : RTC_SCENE_FLAG_NONE);
        api.rtcSetSceneBuildQuality(scene, build);
    }

    void attachPlacements(EmbreeMode mode, RTCBuildQuality build) {
        const EmbreeApi& api = embreeApi();
        for (const Prototype& p : arrays_->prototypes) {
            const RTCScene prototype = prototypes_.emplace_back(api.rtcNewScene(device_->handle()));
            configure(prototype, mode, build);
            attach(prototype, triangles(p.firstTriangle, p.triangles), native::kTriangleGeometry,
                   build);
            api.rtcCommitScene(prototype);
        }
        for (const Placement& p : arrays_->placements) {
            RTCGeometry g = api.rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_INSTANCE);
            api.rtcSetGeometryInstancedScene(g, prototypes_[p.prototype]);
            api.rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, &p.toWorld[0].x);
            api.rtcCommitGeometry(g);
            api.rtcAttachGeometry(scene_, g);
            api.rtcReleaseGeometry(g);
        }
    }

    RTCGeometry triangles(uint32_t first, uint32_t count) const {
        const EmbreeApi& api = embreeApi();
        RTCGeometry g = api.rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_TRIANGLE);
        api.rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                       arrays_->positions.data(), 0, sizeof(glm::vec3),
                                       arrays_->positions.size() - 1);
        api.rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                       arrays_->indices.data(), first * 3 * sizeof(uint32_t),
                                       3 * sizeof(uint32_t), count);
        return g;
    }

    RTCGeometry spheres() const {
        const EmbreeApi& api = embreeApi();
        RTCGeometry g = api.rtcNewGeometry(device_->handle(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
        api.rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                       arrays_->spheres.data(), 0, sizeof(glm::vec4),
                                       arrays_->spheres.size());
        return g;
    }

    static void attach(RTCScene scene, RTCGeometry geometry, uint32_t number,
                       RTCBuildQuality quality) {
        const EmbreeApi& api = embreeApi();
        api.rtcSetGeometryBuildQuality(geometry, quality);
        api.rtcCommitGeometry(geometry);
        api.rtcAttachGeometryByID(scene, geometry, number);
        api.rtcReleaseGeometry(geometry); // the scene keeps it
    }

    native::Tracer tracer() const {
        return {scene_, embreeApi().rtcIntersect1, embreeApi().rtcOccluded1};
    }

    RayTotals run(const RaySet& set, float* distances) const {
        static_assert(sizeof(gpu::TracedRay) == 8 * sizeof(float));
        RayTotals totals;
        std::mutex mutex;
        forBlocks(device_->threads(), set.rays.size(), kRayBlock, native::prepareThread,
                  [&](uint64_t first, uint64_t count) {
                      const native::Totals t = native::traceRays(
                          tracer(), set.anyHit, &set.rays[0].origin.x, first, count, distances);
                      const std::lock_guard lock(mutex);
                      totals.hits += t.hits;
                      totals.distances += t.distances;
                  });
        return totals;
    }

    std::shared_ptr<const Device> device_;
    std::shared_ptr<const Arrays> arrays_;
    RTCScene scene_;
    std::vector<RTCScene> prototypes_;
};

class LoadedEmbree final : public Embree {
  public:
    explicit LoadedEmbree(uint32_t threads) : device_(std::make_shared<Device>(threads)) {}

    std::shared_ptr<const EmbreeGeometry> geometry(const Scene& scene) const override {
        return std::make_shared<Arrays>(scene);
    }

    std::unique_ptr<EmbreeScene> build(std::shared_ptr<const EmbreeGeometry> geometry,
                                       EmbreeMode mode, EmbreeQuality quality) const override {
        return std::make_unique<BuiltScene>(
            device_, std::static_pointer_cast<const Arrays>(std::move(geometry)), mode, quality);
    }

    std::string version() const override {
        const auto property = [&](RTCDeviceProperty p) {
            return embreeApi().rtcGetDeviceProperty(device_->handle(), p);
        };
        return fmt::format("{}.{}.{}", property(RTC_DEVICE_PROPERTY_VERSION_MAJOR),
                           property(RTC_DEVICE_PROPERTY_VERSION_MINOR),
                           property(RTC_DEVICE_PROPERTY_VERSION_PATCH));
    }

    std::string compiledWith() const override { return STROMBOLI_EMBREE_FLAGS; }

  private:
    std::shared_ptr<const Device> device_;
};

/// Whether this CPU has the instructions that embree_rays.cpp was compiled for.
bool raysRunHere() {
#ifdef STROMBOLI_EMBREE_RAYS_NEED_AVX2
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
           __builtin_cpu_supports("bmi2");
#else
    return true;
#endif
}

} // namespace

OpenedEmbree openEmbree(uint32_t threads) {
    if (!raysRunHere())
        return {nullptr,
                "this CPU has no AVX2, which the loops over rays for Embree are compiled for"};
    if (!embreeApi().missing.empty()) return {nullptr, embreeApi().missing};
    return {std::make_unique<LoadedEmbree>(threads), {}};
}

} // namespace stromboli::bench
