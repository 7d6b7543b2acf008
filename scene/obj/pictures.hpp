#pragma once

#include "scene/build/companion.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/obj/mtl_file.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::obj {

/// The pictures of materials as textures of the scene. A picture that is not there or cannot be
/// read is forgiven: there is no texture.
class Pictures {
  public:
    Pictures(std::filesystem::path folder, build::SceneBuilder& builder)
        : folder_(std::move(folder)), builder_(builder) {}

    /// Colours, in sRGB.
    std::optional<uint32_t> colors(const Map& map);
    /// Colours, in sRGB, with an opacity in alpha; either may be missing.
    std::optional<uint32_t> colorsWithOpacity(const std::optional<Map>& color,
                                              const std::optional<Map>& opacity);
    /// As TextureSlot::MetallicRoughness; either may be missing.
    std::optional<uint32_t> roughnessMetallic(const std::optional<Map>& roughness,
                                              const std::optional<Map>& metallic);
    /// Directions.
    std::optional<uint32_t> normals(const Map& map);
    /// Directions that programs write as bumps; nothing for heights.
    std::optional<uint32_t> normalsOfBump(const Map& map);

  private:
    build::Companion fileOf(const Map& map) const;
    std::optional<TextureImage> read(const Map& map, bool srgb);
    std::optional<TextureImage> read(const std::optional<Map>& map, bool srgb);
    uint32_t keep(TextureImage image, const Map& map, bool srgb);
    template <typename Make>
    std::optional<uint32_t> once(const std::string& key, Make make);

    std::filesystem::path folder_;
    build::SceneBuilder& builder_;
    std::map<std::string, std::optional<uint32_t>> made_;
    uint64_t bytes_ = 0; ///< of all pictures that are kept
};

} // namespace stromboli::obj
