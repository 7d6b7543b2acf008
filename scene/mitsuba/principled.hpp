#pragma once

#include "scene/mitsuba/surface_maker.hpp"

namespace stromboli::mitsuba {

/// Mitsuba's principled BSDF (Burley 2012 and 2015).
Surface principled(SurfaceMaker& maker);
/// The material of a thin sheet (principledthin).
Surface principledThin(SurfaceMaker& maker);

} // namespace stromboli::mitsuba
