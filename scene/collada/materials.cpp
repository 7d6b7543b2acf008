#include "scene/collada/materials.hpp"

#include "scene/collada/effects.hpp"

#include <fmt/format.h>

namespace stromboli::collada {

uint32_t Materials::indexOf(const Element& material) {
    return table_.indexOf(&material, [&] {
        const Element& instance = context_.document.require(material, "instance_effect");
        for (const Element& child : children(instance))
            if (named(child, "setparam"))
                context_.report.ignore("<setparam>", "effects are read with their own values");
        const Element& effect = context_.document.resolve(instance, "url", "effect");
        return readEffect(context_, effect, displayName(material));
    });
}

BoundMaterials::BoundMaterials(Context& context, Materials& materials,
                               const Element& instanceGeometry)
    : context_(context) {
    const Document& document = context.document;
    const Element* binding = instanceGeometry.FirstChildElement("bind_material");
    if (!binding) return;
    for (const Element& at : children(document.require(*binding, "technique_common"))) {
        if (!named(at, "instance_material")) continue;
        const uint32_t index = materials.indexOf(document.resolve(at, "target", "material"));
        bySymbol_.try_emplace(document.requireAttribute(at, "symbol"), index);
        if (!first_) first_ = index;
        for (const Element& child : children(at))
            if (!named(child, "extra"))
                context.report.ignore(fmt::format("<{}>", child.Name()),
                                      "textures are not rendered");
    }
}

uint32_t BoundMaterials::indexFor(const std::string& symbol) const {
    if (context_.conventions.materialBinding == MaterialBinding::FirstForMesh) return first();
    const auto found = bySymbol_.find(symbol);
    return found == bySymbol_.end() ? missing() : found->second;
}

uint32_t BoundMaterials::first() const {
    return first_ ? *first_ : missing();
}

uint32_t BoundMaterials::missing() const {
    context_.report.warn("a surface without a bound material is rendered mid grey (0.5)");
    return context_.builder.defaultMaterial();
}

} // namespace stromboli::collada
