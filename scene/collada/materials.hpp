#pragma once

#include "scene/build/material_table.hpp"
#include "scene/collada/context.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>

namespace stromboli::collada {

/// The <material>s of the document, each read once.
class Materials {
  public:
    explicit Materials(Context& context) : context_(context), table_(context.builder) {}

    /// The scene's number of a <material>.
    uint32_t indexOf(const Element& material);

  private:
    Material read(const Element& material);

    Context& context_;
    build::MaterialTable<const Element*> table_;
};

/// The <bind_material> of an <instance_geometry> or <instance_controller>: which symbol stands for
/// which material.
class BoundMaterials {
  public:
    BoundMaterials(Context& context, Materials& materials, const Element& instance);

    /// The material bound to a primitive's symbol; mid grey, with a warning, where none is.
    uint32_t indexFor(const std::string& symbol) const;
    /// The material of a geometry without symbols (a sphere): the first one bound.
    uint32_t first() const;

  private:
    uint32_t missing() const;

    Context& context_;
    std::optional<uint32_t> first_;
    std::unordered_map<std::string, uint32_t> bySymbol_;
};

} // namespace stromboli::collada
