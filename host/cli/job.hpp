#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/cli/options.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

namespace stromboli {

/// A scene that is loaded, its camera and the final settings.
struct Job {
    Scene scene;
    Camera camera;
    RenderSettings settings;
    double loadSeconds = 0;
};

/// Loads the scene, reports what was ignored, dropped or is missing (no light, no camera), and
/// fixes the picture's size. Throws SceneError, UsageError (crop outside the picture).
Job prepareJob(const Options& options);

/// A BVH and the kernel's arrays.
struct BuiltScene {
    BinaryTree tree;
    GpuScene gpu;
    double buildSeconds = 0;
};
BuiltScene buildScene(const Job& job);

} // namespace stromboli
