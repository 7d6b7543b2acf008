#pragma once

#include "host/bvh/kept_trees.hpp"
#include "host/cli/options.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/vulkan/open_device.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <future>

namespace stromboli {

/// A scene that is loaded, its camera and the final settings.
struct Job {
    Scene scene;
    Camera camera;
    RenderSettings settings;
    double loadSeconds = 0;
};

/// Begins to open the device on a thread of its own: nearly all of it is loading and linking the
/// driver's libraries, which takes as long as reading a scene. get() throws DeviceError.
std::future<vulkan::OpenDevice> openDeviceMeanwhile(const Options& options);

/// Loads or makes the scene, and reports what was ignored, dropped or is missing (no light). Throws
/// SceneError.
Job loadJob(const Options& options);
/// Another moment of the file that `before` was loaded from, without a report. What no moment
/// changes is taken from there.
Job loadMoment(const Options& options, Job& before);
/// Fixes the camera, which it reports, the picture's size and the settings. Throws SceneError,
/// UsageError (crop outside the picture).
void setPicture(Job& job, const Options& options);
/// Both.
Job prepareJob(const Options& options);

/// A BVH and the kernel's arrays. Each of these functions says what it does with nowDoing().
struct BuiltScene {
    GpuScene gpu;
    double buildSeconds = 0;
};
/// What one moment of an animation keeps for the next.
struct KeptParts {
    KeptTrees trees;
    std::shared_ptr<const EnvironmentTable> environment;
};
/// kept: where the scene is a moment of a sequence. gatheredRows: of planDetails().
BuiltScene buildScene(const Job& job, KeptParts* kept = nullptr,
                      uint64_t gatheredRows = kUsualGatheredRows);

} // namespace stromboli
