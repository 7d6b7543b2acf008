#pragma once

#include "scene/mitsuba/bsdfs.hpp"

#include <optional>

namespace stromboli::mitsuba {

// BSDFs that change or mix others, which are inside of them.

/// The only BSDF inside; throws SceneError where there is none.
Surface insideOf(Context& context, Textures& textures, const Plugin& plugin);

/// One of two surfaces, the second one in a share of cases: `weight`, or what a picture says. Where
/// they cannot be mixed, which is said of `plugin`, that of the larger share.
Surface mixed(const Plugin& plugin, Surface first, Surface second, double weight,
              const std::optional<TextureUse>& picture);

/// The back is the front's mirror image, or a bsdf of its own.
Surface twoSided(Context& context, Textures& textures, const Plugin& plugin);
Surface mask(Context& context, Textures& textures, const Plugin& plugin);
Surface normalMap(Context& context, Textures& textures, const Plugin& plugin);
Surface bumpMap(Context& context, Textures& textures, const Plugin& plugin);
/// One of two bsdfs, the second one in the share of cases that `weight` says.
Surface blend(Context& context, Textures& textures, const Plugin& plugin);
/// Any number of bsdfs, each with the share that `weights` lists.
Surface mixture(Context& context, Textures& textures, const Plugin& plugin);

} // namespace stromboli::mitsuba
