#pragma once

#include "host/film/film.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/render/estimator.hpp"
#include "scene/camera/camera.hpp"
#include "shaders/shared/render_types.h"

namespace stromboli {

/// The uniform data of a picture.
gpu::Frame makeFrame(const GpuScene& scene, const Camera& camera, const PictureArea& area,
                     const Estimator& estimator);

} // namespace stromboli
