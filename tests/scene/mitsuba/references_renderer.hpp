#pragma once

#include "host/film/film.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"

namespace stromboli::test {

/// Renders with the renderer that the executable is about: references_with_kernel.cpp or
/// references_with_reference.cpp.
Film filmWith(const Scene& scene, const Camera& camera, const RenderSettings& settings);
/// The reference finds light on surfaces and around by bounces alone where facets are narrow, which
/// is noisier than what Mitsuba does.
extern const bool kCombinesLightSamplesWithBounces;

} // namespace stromboli::test
