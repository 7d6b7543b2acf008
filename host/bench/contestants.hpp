#pragma once

#include "host/bench/embree.hpp"
#include "host/bench/measuring.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/device.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <memory>
#include <string>

namespace stromboli::bench {

struct BenchScene {
    std::string name;
    std::string file; ///< empty: made in memory
    Scene scene;
};

/// `name`: as readScene understands it. Throws SceneError.
BenchScene loadBenchScene(const std::string& name);

/// What all parts of the benchmark of one scene work on.
struct Arena {
    const vulkan::Device& device;
    const Embree* embree; ///< null: there is none
    uint32_t threads;
    AlternatePlan plan;
    const BenchScene& scene;
    Camera camera;
    RenderSettings settings;
};

Camera cameraOf(const BenchScene& scene, const RenderSettings& settings);

/// Embree's structures of a scene; both null without Embree.
struct EmbreePair {
    std::unique_ptr<EmbreeScene> fast, robust;
    EmbreeQuality quality = EmbreeQuality::Medium;
};

/// Builds both with the quality that traces these rays faster (by CPU time), so that Embree is at
/// its best.
EmbreePair buildBest(const Arena& arena, const RaySet& rays);

const char* nameOf(EmbreeQuality quality);

} // namespace stromboli::bench
