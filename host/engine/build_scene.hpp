#pragma once

#include "host/bvh/two_level_layout.hpp"
#include "host/engine/listener.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/render/estimator.hpp"
#include "scene/model/scene.hpp"

#include <memory>

namespace stromboli {

/// A BVH and the kernel's arrays.
struct BuiltScene {
    GpuScene gpu;
    double seconds = 0; ///< that building took
};

/// What one moment of an animation keeps for the next.
struct KeptParts {
    KeptTrees trees;
    std::shared_ptr<const EnvironmentTable> environment;
};

/// kept: where the scene is a moment of a sequence. gatheredRows: of planDetails().
BuiltScene buildScene(const Scene& scene, const Estimator& estimator, const Listener& listener = {},
                      KeptParts* kept = nullptr, uint64_t gatheredRows = kUsualGatheredRows);

} // namespace stromboli
