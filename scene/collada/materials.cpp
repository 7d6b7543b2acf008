#include "scene/collada/materials.hpp"

#include "scene/collada/effects.hpp"

#include <fmt/format.h>

namespace stromboli::collada {

uint32_t MaterialTable::add(Material material) {
    context_.scene.materials.push_back(std::move(material));
    return uint32_t(context_.scene.materials.size() - 1);
}

uint32_t MaterialTable::indexOf(const Element& material) {
    const auto [found, isNew] = indices_.try_emplace(&material);
    if (isNew) {
        const Element& instance = context_.document.require(material, "instance_effect");
        for (const Element& child : children(instance))
            if (named(child, "setparam"))
                context_.report.ignore("<setparam>", "effects are read with their own values");
        const Element& effect = context_.document.resolve(instance, "url", "effect");
        found->second = add(readEffect(context_, effect, displayName(material)));
    }
    return found->second;
}

uint32_t MaterialTable::defaultIndex() {
    if (!default_) {
        Material grey;
        grey.name = "default";
        grey.albedo = glm::vec3(0.5f);
        default_ = add(grey);
    }
    return *default_;
}

MaterialBinding::MaterialBinding(Context& context, MaterialTable& table,
                                 const Element& instanceGeometry)
    : context_(context), table_(table) {
    const Document& document = context.document;
    const Element* binding = instanceGeometry.FirstChildElement("bind_material");
    if (!binding) return;
    for (const Element& at : children(document.require(*binding, "technique_common"))) {
        if (!named(at, "instance_material")) continue;
        const uint32_t index = table.indexOf(document.resolve(at, "target", "material"));
        bySymbol_.try_emplace(document.requireAttribute(at, "symbol"), index);
        if (!first_) first_ = index;
        for (const Element& child : children(at))
            if (!named(child, "extra"))
                context.report.ignore(fmt::format("<{}>", child.Name()),
                                      "textures are not rendered");
    }
}

uint32_t MaterialBinding::indexFor(const std::string& symbol) const {
    if (context_.options.cs184) return first();
    const auto found = bySymbol_.find(symbol);
    return found == bySymbol_.end() ? missing() : found->second;
}

uint32_t MaterialBinding::first() const {
    return first_ ? *first_ : missing();
}

uint32_t MaterialBinding::missing() const {
    context_.report.warn("a surface without a bound material is rendered mid grey (0.5)");
    return table_.defaultIndex();
}

} // namespace stromboli::collada
