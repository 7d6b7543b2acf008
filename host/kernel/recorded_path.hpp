#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/render/recorded_path.hpp"
#include "shaders/shared/record_types.h"

#include <span>

namespace stromboli {

/// What a kernel that records has written (shaders/include/recording.glsl), in the scene's terms.
/// counted: how many events there were, of which the last ones may be left out. branches: of the
/// sample. Radiance and rejection are left to the caller.
RecordedPath recordedPath(std::span<const gpu::PathEvent> events, uint32_t counted,
                          uint32_t branches, const GpuScene& scene);

} // namespace stromboli
