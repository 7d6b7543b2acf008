#include "scene/gltf/materials.hpp"

#include "host/core/error.hpp"
#include "scene/gltf/material_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::gltf {
namespace {

const TextureUse* useOf(const Material& material, TextureSlot slot) {
    for (const TextureUse& use : material.textures)
        if (use.slot == slot) return &use;
    return nullptr;
}

/// Those whose coordinates tangents follow.
const TextureUse* tangentUseOf(const Material& material) {
    // Where several want tangents, those that the surface's own normal map was made with count.
    for (const TextureSlot slot :
         {TextureSlot::Normal, TextureSlot::ClearcoatNormal, TextureSlot::Anisotropy})
        if (const TextureUse* use = useOf(material, slot)) return use;
    return nullptr;
}

/// How the tangent that belongs to a map's coordinates lies in the frame of the mesh's own.
struct Turn {
    double angle = 0; ///< radians, from the tangent towards the bitangent
    double sense = 1; ///< -1: the map is mirrored, so that its bitangent lies on the other side
};

/// rows: those that take texture coordinates to the map's.
Turn turnOf(const glm::dvec2& uRow, const glm::dvec2& vRow) {
    const double sense = uRow.x * vRow.y < uRow.y * vRow.x ? -1 : 1;
    return {std::atan2(sense * vRow.x, sense * vRow.y), sense};
}

/// The surface's tangents are those of `frame`. The direction of anisotropy is one in the frame of
/// its own map or, without one, in that of the mesh's own tangents.
void keepAnisotropy(Material& material, const Turn& frame) {
    const TextureUse* const map = useOf(material, TextureSlot::Anisotropy);
    const Turn own = map ? turnOf(glm::dvec2(map->uRow), glm::dvec2(map->vRow)) : Turn{};
    // A direction at the angle a of its own frame has the angle own.angle + own.sense a in the
    // mesh's. A map adds its own angles later, so that only maps of one sense can be told in the
    // other's frame.
    const double sense = map ? 1 : frame.sense;
    float& angle = material.principled.anisotropyRotation;
    angle = float(sense * double(angle) + frame.sense * (own.angle - frame.angle));
}

/// Whether a map holds directions in a frame that the surface's tangents, which follow the
/// coordinates of `tangents`, cannot stand for.
bool isOfAnotherFrame(const Material& material, TextureSlot slot, const TextureUse& tangents) {
    const TextureUse* const map = useOf(material, slot);
    if (!map) return false;
    const Turn own = turnOf(glm::dvec2(map->uRow), glm::dvec2(map->vRow));
    const Turn frame = turnOf(glm::dvec2(tangents.uRow), glm::dvec2(tangents.vRow));
    return map->uvSet != tangents.uvSet || own.sense != frame.sense ||
           (slot == TextureSlot::ClearcoatNormal && own.angle != frame.angle);
}

} // namespace

std::vector<std::string> variantNames(const Document& document) {
    std::vector<std::string> names;
    if (const auto extension = document.root().extension("KHR_materials_variants"))
        for (size_t i = 0; i < extension->size("variants"); ++i)
            names.push_back(extension->item("variants", i).text("name"));
    return names;
}

std::optional<size_t> chosenVariant(const Document& document, build::SceneBuilder& builder) {
    const std::vector<std::string> names = variantNames(document);
    const std::string& wanted = builder.conventions().selection.variant;
    const std::string list = fmt::format("{}", fmt::join(names, ", "));
    if (wanted.empty()) {
        if (!names.empty())
            builder.report().assume(fmt::format(
                "the file has the variants {}: its own materials are shown (--variant)", list));
        return std::nullopt;
    }
    const auto found = std::find(names.begin(), names.end(), wanted);
    if (found == names.end())
        document.root().fail(names.empty()
                                 ? fmt::format("has no variants; --variant asks for '{}'", wanted)
                                 : fmt::format("has no variant '{}'; there are {}", wanted, list));
    return size_t(found - names.begin());
}

std::optional<size_t> Materials::indexFor(const Element& primitive) const {
    const size_t count = context_.document.size("materials");
    const auto extension = primitive.extension("KHR_materials_variants");
    if (extension && context_.variant)
        for (const Element& mapping : extension->items("mappings"))
            for (const size_t variant : mapping.indicesOr("variants", size_t(-1)))
                if (variant == *context_.variant) return mapping.index("material", count);
    return primitive.index("material", count);
}

const BoundMaterial& Materials::of(const Element& primitive) {
    const std::optional<size_t> index = indexFor(primitive);
    const auto found = made_.find(index);
    if (found != made_.end()) return found->second;
    return made_.emplace(index, index ? readOrGrey(*index) : standard()).first->second;
}

BoundMaterial Materials::readOrGrey(size_t index) {
    try {
        return read(context_.document.at("materials", index));
    } catch (const SceneError& error) {
        context_.report().replace(error, build::Shortfall::Material);
    }
    BoundMaterial bound;
    bound.number = context_.builder.addMaterial(build::greyMaterial());
    return bound;
}

BoundMaterial Materials::read(const Element& element) {
    MaterialReader reader(context_, textures_, element);
    Material material = reader.read();
    BoundMaterial bound;
    bound.uvSets = reader.uvSets();
    if (element.extension("KHR_materials_unlit")) bound.unlit = material;
    bound.isTextured = !material.textures.empty();
    if (const TextureUse* use = tangentUseOf(material)) {
        bound.tangentSet = int(use->uvSet);
        bound.tangentRows[0] = glm::dvec2(use->uRow);
        bound.tangentRows[1] = glm::dvec2(use->vRow);
        const Turn frame = turnOf(bound.tangentRows[0], bound.tangentRows[1]);
        for (const TextureSlot slot : {TextureSlot::ClearcoatNormal, TextureSlot::Anisotropy})
            if (isOfAnotherFrame(material, slot, *use))
                context_.report().replace(element.place(), build::Shortfall::Model,
                                          "maps of directions have coordinates of their own");
        keepAnisotropy(material, frame);
    } else if (material.principled.anisotropy > 0) {
        bound.tangentSet = 0;
    }
    bound.number = context_.builder.addMaterial(std::move(material));
    return bound;
}

/// That of primitives that name none: all members of a material at their defaults.
BoundMaterial Materials::standard() {
    Material material;
    material.name = "default";
    material.kind = MaterialKind::Principled;
    BoundMaterial bound;
    bound.number = context_.builder.addMaterial(std::move(material));
    return bound;
}

} // namespace stromboli::gltf
