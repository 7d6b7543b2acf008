#pragma once

#include "scene/mitsuba/context.hpp"
#include "scene/mitsuba/textures.hpp"

#include <memory>

namespace stromboli::mitsuba {

/// What a BSDF of the file makes of a surface.
struct Surface {
    Material material;
    std::string cornerColors;       ///< the mesh attribute that its base colour is; empty: none
    TextureUse cornerPaint;         ///< the same as a texture (Textures::paintOf)
    std::shared_ptr<Surface> other; ///< Material::other of its material
};

/// Mid grey where there is nothing that comes near, which is said.
Surface readBsdf(Context& context, Textures& textures, const Plugin& bsdf);

} // namespace stromboli::mitsuba
