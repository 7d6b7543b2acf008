#pragma once

#include "scene/mitsuba/bsdfs.hpp"

namespace stromboli::mitsuba {

/// What comes nearest to a BSDF of a type that does not exist here, which is said: those of Mitsuba
/// 0.x and all whose names are not known. Throws SceneError where nothing does.
Surface replacedBsdf(Context& context, Textures& textures, const Plugin& bsdf);

} // namespace stromboli::mitsuba
