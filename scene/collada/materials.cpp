#include "scene/collada/materials.hpp"

#include "scene/collada/effects.hpp"

#include <fmt/format.h>

namespace stromboli::collada {

Material Materials::read(const Element& material) {
    const Document& document = context_.document;
    const Element* instance = material.FirstChildElement("instance_effect");
    if (!instance) document.forgive(material, "has no <instance_effect>", kGreyInstead);
    if (instance)
        for (const Element& child : children(*instance))
            if (named(child, "setparam"))
                context_.report.ignore("<setparam>", "effects are read with their own values");
    const Element* effect =
        instance ? document.resolveOr(*instance, "url", "effect", kGreyInstead) : nullptr;
    if (effect) return readEffect(context_, *effect, displayName(material));
    Material grey = build::greyMaterial();
    grey.name = displayName(material);
    return grey;
}

uint32_t Materials::indexOf(const Element& material) {
    return table_.indexOf(&material, [&] { return read(material); });
}

BoundMaterials::BoundMaterials(Context& context, Materials& materials, const Element& instance)
    : context_(context) {
    const Document& document = context.document;
    const Element* binding = instance.FirstChildElement("bind_material");
    if (!binding) return;
    const Element* technique = binding->FirstChildElement("technique_common");
    if (!technique) {
        document.forgive(*binding, "has no <technique_common>", "it binds nothing");
        return;
    }
    for (const Element& at : children(*technique)) {
        if (!named(at, "instance_material")) continue;
        const Element* material = document.resolveOr(at, "target", "material", kGreyInstead);
        const uint32_t index =
            material ? materials.indexOf(*material) : context.builder.defaultMaterial();
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
