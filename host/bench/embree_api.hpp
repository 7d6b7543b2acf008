#pragma once

#include <embree3/rtcore.h>

#include <string>

namespace stromboli::bench {

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

/// Loaded at the first call and never unloaded.
const EmbreeApi& embreeApi();

} // namespace stromboli::bench
