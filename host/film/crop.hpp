#pragma once

#include "host/film/film.hpp"
#include "host/film/picture_area.hpp"

namespace stromboli {

/// The part of the film that `crop` names: the whole film if its width is 0. Throws UsageError
/// if it is not inside the film or has no pixels.
Crop cropInside(const Film& film, const Crop& crop);

} // namespace stromboli
