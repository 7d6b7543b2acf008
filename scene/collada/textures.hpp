#pragma once

#include "scene/collada/context.hpp"
#include "scene/collada/parameters.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace stromboli::collada {

/// Samplers and pictures of the document, each of which is read when a material uses it.
class Textures {
  public:
    explicit Textures(Context& context) : context_(context) {}

    /// The scene's number of what a <texture>, or the <newparam> of a sampler, stands for; nothing
    /// where no picture is found or it cannot be read, which is forgiven: `reading` says what
    /// becomes of it.
    std::optional<uint32_t> read(const Scope& scope, const Element& texture, const char* reading);

  private:
    struct Image {
        std::optional<uint32_t> number;
        std::string problem; ///< why there is none
    };

    const Element* imageOf(const Scope& scope, const Element& sampler, const char* reading) const;
    std::optional<uint32_t> texture(const Element* sampler, const Element& image,
                                    const char* reading);
    std::optional<uint32_t> image(const Element& image, const char* reading);
    Image load(const Element& image);
    void requireRoom(uint64_t bytes, const Element& image);

    Context& context_;
    std::map<const Element*, Image> images_;
    /// By <sampler2D> (null: none) and <image>.
    std::map<std::pair<const Element*, const Element*>, uint32_t> textures_;
    uint64_t bytes_ = 0; ///< of all pictures that are kept
};

} // namespace stromboli::collada
