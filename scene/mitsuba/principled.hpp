#pragma once

#include "scene/mitsuba/surface_maker.hpp"

namespace stromboli::mitsuba {

/// Mitsuba's principled BSDF (Burley 2012 and 2015) as glTF's: docs/mitsuba.md says what becomes of
/// its parameters.
Surface principled(SurfaceMaker& maker);

} // namespace stromboli::mitsuba
