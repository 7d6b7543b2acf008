#include "scene/collada/materials.hpp"

#include "scene/build/number_word.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/collada/numbers.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

namespace stromboli::collada {
namespace {

/// The number at the end of a name such as CHANNEL1.
std::optional<uint32_t> numberAtEnd(std::string_view name) {
    const size_t last = name.find_last_not_of("0123456789");
    return build::countIn(name.substr(last == std::string_view::npos ? 0 : last + 1));
}

/// The input of that set; null where there is none.
const Element* inputOfSet(const Document& document, const Primitive& primitive, uint32_t set) {
    for (const Element* input : primitive.texcoords)
        if (readCountOr(document, *input, "set", 0) == set) return input;
    return nullptr;
}

/// The <bind_vertex_input> of that name; null where there is none.
const Element* bindingOf(const Element& instanceMaterial, const std::string& name) {
    for (const Element& at : children(instanceMaterial)) {
        const char* semantic = at.Attribute("semantic");
        const char* input = at.Attribute("input_semantic");
        const bool isTexcoord = named(at, "bind_vertex_input") && semantic && name == semantic &&
                                input && std::string_view(input) == "TEXCOORD";
        if (isTexcoord) return &at;
    }
    return nullptr;
}

} // namespace

EffectMaterial Materials::read(const Element& material) {
    const Document& document = context_.document;
    const Element* instance = material.FirstChildElement("instance_effect");
    if (!instance) document.forgive(material, "has no <instance_effect>", kGreyInstead);
    if (instance)
        for (const Element& child : children(*instance))
            if (named(child, "setparam"))
                context_.report.ignore("<setparam>", "effects are read with their own values");
    const Element* effect =
        instance ? document.resolveOr(*instance, "url", "effect", kGreyInstead) : nullptr;
    if (effect) return readEffect(context_, textures_, *effect, displayName(material));
    EffectMaterial grey{build::greyMaterial(), {}};
    grey.material.name = displayName(material);
    return grey;
}

Materials::Entry& Materials::entry(const Element& material) {
    const auto [found, isNew] = read_.try_emplace(&material);
    if (isNew) found->second.effect = read(material);
    return found->second;
}

const std::vector<EffectTexture>& Materials::texturesOf(const Element& material) {
    return entry(material).effect.textures;
}

uint32_t Materials::indexOf(const Element& element, TexcoordUse use) {
    Entry& entry = this->entry(element);
    if (entry.effect.textures.empty()) use = TexcoordUse::None;
    std::optional<uint32_t>& number = entry.numbers[size_t(use)];
    if (number) return *number;
    Material material = entry.effect.material;
    for (const EffectTexture& texture : entry.effect.textures) {
        const bool isEmission = texture.slot == TextureSlot::Emission;
        if (use == TexcoordUse::None) {
            if (isEmission) material.emission = glm::vec3(0);
            if (texture.slot == TextureSlot::BaseColor) *material.baseColor() = glm::vec3(0.5f);
            if (texture.slot == TextureSlot::Opacity) material.alphaMode = AlphaMode::Opaque;
            continue;
        }
        TextureUse shown;
        shown.slot = texture.slot;
        shown.texture = texture.texture;
        shown.scale = texture.scale;
        shown.uvSet = isEmission && use == TexcoordUse::Separate ? 1 : 0;
        material.textures.push_back(shown);
    }
    number = context_.builder.addMaterial(std::move(material));
    return *number;
}

BoundMaterials::BoundMaterials(Context& context, Materials& materials, const Element& instance)
    : context_(context), materials_(materials) {
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
        const Bound bound{document.resolveOr(at, "target", "material", kGreyInstead), &at};
        // Those without textures are the same for whatever they cover.
        if (!bound.material)
            context.builder.defaultMaterial();
        else if (materials.texturesOf(*bound.material).empty())
            materials.indexOf(*bound.material, TexcoordUse::None);
        bySymbol_.try_emplace(document.requireAttribute(at, "symbol"), bound);
        if (!first_) first_ = bound;
        for (const Element& child : children(at))
            if (!named(child, "extra") &&
                !(named(child, "bind_vertex_input") && context.conventions.textures))
                context.report.ignore(fmt::format("<{}>", child.Name()),
                                      "it has no effect on the picture");
    }
}

PartMaterial BoundMaterials::of(const Primitive& primitive) const {
    if (context_.conventions.materialBinding == MaterialBinding::FirstForMesh) return {first(), {}};
    const auto found = bySymbol_.find(primitive.symbol);
    if (found == bySymbol_.end()) return {missing(), {}};
    const Bound& bound = found->second;
    if (!bound.material) return {context_.builder.defaultMaterial(), {}};
    PartMaterial part;
    TexcoordUse use = TexcoordUse::None;
    for (const EffectTexture& texture : materials_.texturesOf(*bound.material)) {
        const Element* input = texcoordFor(bound, primitive, texture.texcoord);
        if (!input) return {withoutTexcoords(bound, "a primitive without texture coordinates"), {}};
        const bool isSeparate = use != TexcoordUse::None && part.texcoords[0] != input;
        part.texcoords[isSeparate ? 1 : 0] = input;
        use = isSeparate ? TexcoordUse::Separate : TexcoordUse::Shared;
    }
    part.number = materials_.indexOf(*bound.material, use);
    return part;
}

/// The coordinates that a texture names; null if the primitive has none.
const Element* BoundMaterials::texcoordFor(const Bound& bound, const Primitive& primitive,
                                           const std::string& name) const {
    if (primitive.texcoords.empty()) return nullptr;
    const Document& document = context_.document;
    const Element* first = primitive.texcoords.front();
    if (const Element* binding = bindingOf(*bound.instance, name)) {
        const uint32_t set = readCountOr(document, *binding, "input_set", 0);
        if (const Element* input = inputOfSet(document, primitive, set)) return input;
        document.forgive(*binding, fmt::format("the primitive has no TEXCOORD of the set {}", set),
                         "its first texture coordinates are taken");
        return first;
    }
    const Element* input = nullptr;
    if (const std::optional<uint32_t> set = numberAtEnd(name))
        input = inputOfSet(document, primitive, *set);
    if (primitive.texcoords.size() > 1)
        context_.report.assume("textures that no <bind_vertex_input> binds look up the texture "
                               "coordinates of the number in their name, or else the first ones");
    return input ? input : first;
}

uint32_t BoundMaterials::withoutTexcoords(const Bound& bound, const std::string& shape) const {
    if (!materials_.texturesOf(*bound.material).empty())
        context_.report.warn(fmt::format("the textures of {} are left out: its colour is mid grey "
                                         "(0.5)",
                                         shape));
    return materials_.indexOf(*bound.material, TexcoordUse::None);
}

uint32_t BoundMaterials::first() const {
    if (!first_) return missing();
    return first_->material ? withoutTexcoords(*first_, "a sphere")
                            : context_.builder.defaultMaterial();
}

uint32_t BoundMaterials::missing() const {
    context_.report.warn("a surface without a bound material is rendered mid grey (0.5)");
    return context_.builder.defaultMaterial();
}

} // namespace stromboli::collada
