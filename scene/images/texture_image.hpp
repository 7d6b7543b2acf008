#pragma once

#include "scene/images/picture.hpp"
#include "scene/model/texture.hpp"

namespace stromboli::images {

/// The texels of a picture: 8-bit ones as they are, others as half floats, of which 16-bit colours
/// are decoded where `srgb` says that they are sRGB (alpha never is). Values beyond the largest
/// half float, 65504, become it. Throws SceneError for values that are not numbers.
TextureImage textureImage(const Picture& picture, const std::string& name, bool srgb);

/// Halves a picture, to the mean of the texels that each new one covers, until no side exceeds
/// `largestSide` (at least 1). `srgb`: its 8-bit colours are sRGB, and the mean is one of light.
void shrinkToFit(TextureImage& image, uint32_t largestSide, bool srgb);

} // namespace stromboli::images
