#pragma once

#include "scene/build/report.hpp"
#include "scene/images/picture.hpp"
#include "scene/model/texture.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::images {

/// The picture of a surface, by the one rule about what cannot be read: what is wrong with it is a
/// line of the report, and nothing is returned where there is nothing to show. `bytesOf` may throw
/// SceneError where the bytes are not to be had. `name` is what messages call the picture.
std::optional<TextureImage> loadTexture(const std::function<std::string_view()>& bytesOf,
                                        const std::string& name, bool srgb,
                                        const build::FilePlace& where, build::Report& report);

/// Says what is wrong with a picture that is shown.
void reportFaults(const Picture& picture, const build::FilePlace& where, const std::string& name,
                  build::Report& report);

} // namespace stromboli::images
