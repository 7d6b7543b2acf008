#pragma once

#include "host/film/film.hpp"
#include "host/render/budget.hpp"
#include "host/render/estimator.hpp"

namespace stromboli {

/// A picture of a scene, apart from the scene: which pixels, of what, how many samples. The same
/// settings, scene and device give the same bytes (unless a limit of time ends the render).
struct RenderSettings {
    PictureArea area;
    Estimator estimator;
    Budget budget;
};

} // namespace stromboli
