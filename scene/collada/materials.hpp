#pragma once

#include "scene/collada/context.hpp"

#include <optional>
#include <string>
#include <unordered_map>

namespace stromboli::collada {

/// The materials of the scene, each read once.
class MaterialTable {
  public:
    explicit MaterialTable(Context& context) : context_(context) {}

    /// Index into Scene::materials of a <material>.
    uint32_t indexOf(const Element& material);
    /// Index of the material of surfaces that name none: mid grey.
    uint32_t defaultIndex();

  private:
    uint32_t add(Material material);

    Context& context_;
    std::unordered_map<const Element*, uint32_t> indices_;
    std::optional<uint32_t> default_;
};

/// The <bind_material> of one <instance_geometry>: which symbol stands for which material.
class MaterialBinding {
  public:
    MaterialBinding(Context& context, MaterialTable& table, const Element& instanceGeometry);

    /// The material bound to a primitive's symbol; mid grey, with a warning, where none is. With
    /// cs184 the first material bound counts for all.
    uint32_t indexFor(const std::string& symbol) const;
    /// The material of a geometry without symbols (a sphere): the first one bound.
    uint32_t first() const;

  private:
    uint32_t missing() const;

    Context& context_;
    MaterialTable& table_;
    std::optional<uint32_t> first_;
    std::unordered_map<std::string, uint32_t> bySymbol_;
};

} // namespace stromboli::collada
