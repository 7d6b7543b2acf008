#pragma once

#include "scene/model/scene.hpp"

namespace stromboli {

/// Whether a picture could show anything of it: surfaces, a sky that is not black, or a medium all
/// around.
bool hasSomethingToDraw(const Scene& scene);

/// True if anything gives light: a light, or geometry whose material emits, that is not black.
bool shines(const Scene& scene);

/// Whether it shines likewise, but pictures of emission on surfaces count only where they would
/// light these: lamps of a vehicle or a screen would not, and without more light nothing else is
/// seen of it.
bool lightsItsSurfaces(const Scene& scene);

/// What lights a scene in which nothing shines: a sky that has the same radiance, 1, everywhere
/// above the horizon (y > 0). A white surface that faces up is then as white as a picture can show;
/// others are darker the more they face down, which shows their shape.
Light defaultLight();

} // namespace stromboli
