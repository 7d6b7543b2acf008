#pragma once

#include "scene/build/texels.hpp"
#include "scene/pbrt/colors.hpp"
#include "scene/pbrt/pattern.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

namespace stromboli::pbrt {

/// A colour that is alike everywhere, or a texture of it.
struct Shade {
    glm::dvec3 color{1.0};
    std::optional<TextureUse> texture; ///< times `color`; its slot is to be set
    std::optional<Mapping> mapping;    ///< by which its coordinates go, where that is not Uv
};

/// Textures by their names; those of one number and those of colours may have the same ones.
using TextureTable = std::map<std::pair<bool, std::string>, PatternPointer>;

/// What becomes of the values of a texture before they are in a picture.
using Remap = std::function<glm::dvec3(const glm::dvec3&)>;

/// The textures of a scene.
class Textures {
  public:
    explicit Textures(Context& context) : context_(context) {}

    /// The texture that a directive defines, which may name others.
    PatternPointer make(const std::string& kind, bool isNumber, const Parameters& parameters,
                        const TextureTable& table, const glm::dmat4& worldFromTexture);

    /// A parameter that is a colour, a number or a texture.
    Pattern pattern(const Parameters& parameters, std::string_view name, ColorOf what,
                    const glm::dvec3& otherwise, const TextureTable& table, bool isNumber = false);

    /// The pattern in a picture of the scene, if it is no constant. With `remap`, values of that;
    /// they are where the layout says.
    Shade shade(const Pattern& pattern, const Remap& remap = nullptr,
                build::Layout layout = build::Layout::Color);

    /// A picture of a file as a texture of the scene; nothing where it cannot be shown.
    std::optional<uint32_t> picture(const Parameters& parameters, const std::string& name,
                                    bool isLinear, Wrap wrap);

  private:
    Pattern imageMap(const Parameters& parameters, bool isNumber);
    Pattern checkerboard(const Parameters& parameters, const TextureTable& table, bool isNumber,
                         const Mapping& mapping);
    Pattern dots(const Parameters& parameters, const TextureTable& table, bool isNumber,
                 const Mapping& mapping);
    Pattern bilinear(const Parameters& parameters, bool isNumber);
    Pattern combined(const Parameters& parameters, const Pattern& a, const Pattern& b,
                     const Pattern& c, const Combine& how);
    Pattern meanOfSpace(const Parameters& parameters, const glm::dvec3& mean);
    void readMapping(const Parameters& parameters, const glm::dmat4& worldFromTexture,
                     Mapping& mapping);

    void countBytes(const TextureImage& image, const build::FilePlace& where);

    Context& context_;
    uint32_t made_ = 0;  ///< textures of the file
    uint64_t bytes_ = 0; ///< of all pictures
    std::map<std::tuple<std::string, bool, Wrap>, std::optional<uint32_t>> pictures_;
};

} // namespace stromboli::pbrt
