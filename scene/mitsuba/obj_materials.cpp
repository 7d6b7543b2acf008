#include "scene/mitsuba/obj_materials.hpp"

#include "scene/mitsuba/upgrade.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace stromboli::mitsuba {
namespace {

/// Adds materials of a file, with their textures, to the scene.
class Adopter {
  public:
    Adopter(Context& context, const FileLook& look)
        : context_(context), look_(look), textures_(look.textures.size()),
          images_(look.images.size()) {}

    BoundMaterial adopt(uint32_t number) {
        Material material = look_.materials.at(number);
        BoundMaterial bound;
        bound.isTextured = !material.textures.empty();
        bound.wantsTangents = material.hasGrain();
        for (TextureUse& use : material.textures) {
            bound.wantsTangents = bound.wantsTangents || use.slot == TextureSlot::Normal;
            use.texture = textureOf(use.texture);
        }
        bound.number = context_.builder.addMaterial(std::move(material));
        return bound;
    }

  private:
    uint32_t textureOf(uint32_t number) {
        std::optional<uint32_t>& added = textures_.at(number);
        if (added) return *added;
        Texture texture = look_.textures[number];
        std::optional<uint32_t>& image = images_.at(texture.image);
        if (!image) image = context_.builder.addImage(look_.images[texture.image]);
        texture.image = *image;
        added = context_.builder.addTexture(texture);
        return *added;
    }

    Context& context_;
    const FileLook& look_;
    std::vector<std::optional<uint32_t>> textures_, images_;
};

} // namespace

const Plugin* bsdfFor(const Plugin& shape, const std::string& material) {
    // Names of objects inside others have been made those of later versions, as those of
    // parameters.
    const Plugin* forAll = nullptr;
    for (const Plugin::Child& child : shape.children()) {
        if (child.plugin->tag != "bsdf") continue;
        if (child.name == upgradedName(material)) return child.plugin;
        if (child.name.empty() && !forAll) forAll = child.plugin;
    }
    return forAll;
}

bool usesOwnMaterials(const Plugin& shape) {
    if (shape.type != "obj" || !shape.isOld || !shape.childrenOf("emitter").empty()) return false;
    if (!shape.flag("load_materials").value_or(true)) return false;
    // One bsdf is that of the whole shape, unless its name is that of a material: references to it
    // are often named after what they are.
    const size_t bsdfs = shape.childrenOf("bsdf").size();
    const auto isOfMaterial = [](const Plugin::Child& child) {
        return child.plugin->tag == "bsdf" && !child.name.empty() && child.name != "bsdf";
    };
    return bsdfs != 1 || std::ranges::any_of(shape.children(), isOfMaterial);
}

std::vector<BoundMaterial> bindOwnMaterials(Context& context, Materials& materials,
                                            const Plugin& shape, const FileMesh& file,
                                            build::Mesh& mesh) {
    Adopter adopter(context, file.look);
    std::map<uint32_t, size_t> parts; ///< by the file's materials
    std::vector<BoundMaterial> bound;
    const build::MeshPart triangles = std::move(mesh.parts.at(0));
    mesh.parts.clear();
    for (size_t i = 0; i < triangles.size(); ++i) {
        const uint32_t material = file.materials.at(i);
        const auto [found, isNew] = parts.try_emplace(material, mesh.parts.size());
        if (isNew) {
            mesh.parts.emplace_back();
            const Plugin* bsdf = bsdfFor(shape, file.look.materials.at(material).name);
            bound.push_back(bsdf ? materials.of(shape, *bsdf) : adopter.adopt(material));
        }
        mesh.parts[found->second].push_back(triangles[i]);
    }
    return bound;
}

} // namespace stromboli::mitsuba
