#pragma once

#include "scene/mitsuba/context.hpp"
#include "scene/mitsuba/textures.hpp"

namespace stromboli::mitsuba {

/// What a BSDF of the file makes of a surface.
struct Surface {
    Material material;
    bool usesVertexColors = false; ///< of the mesh that it is on
};

/// Throws SceneError for what cannot be represented.
Surface readBsdf(Context& context, Textures& textures, const Plugin& bsdf);

} // namespace stromboli::mitsuba
