#pragma once

#include "scene/collada/context.hpp"
#include "scene/collada/effects.hpp"
#include "scene/collada/primitives.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>

namespace stromboli::collada {

/// Which of the corners' two texture coordinates the textures of a material look up.
enum class TexcoordUse {
    None,     ///< there are none: it has no textures
    Shared,   ///< all the first ones
    Separate, ///< that of the diffuse colour the first ones, that of the emission the second ones
};

/// The <material>s of the document, each read once.
class Materials {
  public:
    explicit Materials(Context& context) : context_(context), textures_(context) {}

    /// The scene's number of a <material> with its textures so used.
    uint32_t indexOf(const Element& material, TexcoordUse use);
    /// The textures of a <material>.
    const std::vector<EffectTexture>& texturesOf(const Element& material);

  private:
    struct Entry {
        EffectMaterial effect;
        std::array<std::optional<uint32_t>, 3> numbers; ///< by TexcoordUse
    };

    Entry& entry(const Element& material);
    EffectMaterial read(const Element& material);

    Context& context_;
    Textures textures_;
    std::map<const Element*, Entry> read_;
};

/// The material of a primitive, and the coordinates that its textures look up.
struct PartMaterial {
    uint32_t number = 0;
    TexcoordInputs texcoords{};
};

/// The <bind_material> of an <instance_geometry> or <instance_controller>: which symbol stands for
/// which material, and which names for which texture coordinates.
class BoundMaterials {
  public:
    BoundMaterials(Context& context, Materials& materials, const Element& instance);

    /// The material bound to a primitive; mid grey, with a warning, where none is.
    PartMaterial of(const Primitive& primitive) const;
    /// The material of a geometry without symbols (a sphere), which has no texture coordinates: the
    /// first one bound.
    uint32_t first() const;

  private:
    struct Bound {
        const Element* material = nullptr; ///< null: mid grey
        const Element* instance = nullptr; ///< the <instance_material>
    };

    const Element* texcoordFor(const Bound& bound, const Primitive& primitive,
                               const std::string& name) const;
    uint32_t withoutTexcoords(const Bound& bound, const std::string& shape) const;
    uint32_t missing() const;

    Context& context_;
    Materials& materials_;
    std::optional<Bound> first_;
    std::unordered_map<std::string, Bound> bySymbol_;
};

} // namespace stromboli::collada
