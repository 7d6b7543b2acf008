#pragma once

#include "host/bench/device_rays.hpp"
#include "scene/model/scene.hpp"

#include <memory>
#include <string>
#include <vector>

/// Embree (https://www.embree.org), the CPU ray tracer that Stromboli is measured against. It is
/// optional twice: without its headers the program is built without it, without its library
/// openEmbree() says so. The library is loaded here, not with the program: that takes 3 ms.
namespace stromboli::bench {

enum class EmbreeMode {
    Fast,   ///< its default: Moeller-Trumbore, boxes without slack
    Robust, ///< RTC_SCENE_FLAG_ROBUST: watertight, as ours always is
};

enum class EmbreeQuality {
    Medium, ///< its default: binned SAH
    High,   ///< with spatial splits
};

/// A scene's geometry as Embree reads it.
class EmbreeGeometry {
  public:
    virtual ~EmbreeGeometry() = default;
};

/// A scene in Embree's own acceleration structure.
class EmbreeScene {
  public:
    virtual ~EmbreeScene() = default;
    /// Traces all rays once on all threads, each with rtcIntersect1 or rtcOccluded1.
    virtual RayTotals trace(const RaySet& set) const = 0;
    /// Where each ray ended; the largest float for misses. Shadow rays: 0 for hits.
    virtual std::vector<float> distances(const RaySet& set) const = 0;

    double buildSeconds = 0;
    uint64_t bytes = 0; ///< of the acceleration structure; the geometry comes on top
};

class Embree {
  public:
    virtual ~Embree() = default;
    virtual std::shared_ptr<const EmbreeGeometry> geometry(const Scene& scene) const = 0;
    /// geometry: made by this object. Throws DeviceError.
    virtual std::unique_ptr<EmbreeScene> build(std::shared_ptr<const EmbreeGeometry> geometry,
                                               EmbreeMode mode, EmbreeQuality quality) const = 0;
    virtual std::string version() const = 0;
    /// How the loops that call it were compiled.
    virtual std::string compiledWith() const = 0;
};

struct OpenedEmbree {
    std::unique_ptr<Embree> embree; ///< null: it cannot be used
    std::string missing;            ///< why
};

/// threads: for building and tracing; at least 1.
OpenedEmbree openEmbree(uint32_t threads);

} // namespace stromboli::bench
