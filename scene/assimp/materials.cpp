#include "scene/assimp/materials.hpp"

#include "scene/assimp/assimp_api.hpp"
#include "scene/obj/material_rules.hpp"

#include <assimp/commonMetaData.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace stromboli::assimp {
namespace {

std::optional<glm::dvec3> color(const aiMaterial& m, const char* key, unsigned type,
                                unsigned index) {
    aiColor4D c;
    if (assimpApi().materialColor(&m, key, type, index, &c) != aiReturn_SUCCESS)
        return std::nullopt;
    return glm::dvec3(c.r, c.g, c.b);
}

std::optional<double> number(const aiMaterial& m, const char* key, unsigned type, unsigned index) {
    ai_real x = 0;
    unsigned count = 1;
    if (assimpApi().materialFloats(&m, key, type, index, &x, &count) != aiReturn_SUCCESS ||
        count == 0)
        return std::nullopt;
    return double(x);
}

std::string text(const aiMaterial& m, const char* key, unsigned type, unsigned index) {
    aiString s;
    if (assimpApi().materialString(&m, key, type, index, &s) != aiReturn_SUCCESS) return {};
    return s.C_Str();
}

/// What wraps as a picture of colours does in Assimp's material.
bool clamps(const aiMaterial& m, aiTextureType type) {
    int mode = 0;
    unsigned count = 1;
    ai_real x = 0;
    if (assimpApi().materialFloats(&m, AI_MATKEY_MAPPINGMODE_U(type, 0), &x, &count) ==
        aiReturn_SUCCESS)
        mode = int(x);
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal;
}

bool isOfBlender(const aiScene& scene) {
    aiString program;
    return scene.mMetaData && scene.mMetaData->Get(AI_METADATA_SOURCE_GENERATOR, program) &&
           std::string_view(program.C_Str()).starts_with("Blender");
}

} // namespace

Materials::Materials(const std::filesystem::path& file, const aiScene& scene,
                     std::optional<glm::vec3> color, build::SceneBuilder& builder)
    : file_(file.string()), scene_(scene), color_(color), builder_(builder),
      pictures_(file.parent_path(), builder) {
    std::string suffix = file.extension().string();
    std::ranges::transform(suffix, suffix.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    isWithoutMaterials_ = suffix == ".stl";
    reflectsAsMetal_ = suffix == ".fbx" && isOfBlender(scene);
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        hasColors_ = hasColors_ || scene.mMeshes[i]->HasVertexColors(0);
}

uint32_t Materials::numberOf(unsigned material) {
    return made(material).number;
}

bool Materials::wantsTangents(unsigned material) {
    return made(material).wantsTangents;
}

const Materials::Made& Materials::made(unsigned material) {
    const auto found = made_.find(material);
    if (found != made_.end()) return found->second;
    Made made;
    if (isWithoutMaterials_) {
        // Assimp makes one up, in white.
        Material grey = build::greyMaterial();
        if (hasColors_) grey.albedo = glm::vec3(1);
        if (color_) grey.albedo = *color_;
        made.number = builder_.addMaterial(std::move(grey));
    } else if (material >= scene_.mNumMaterials) {
        made.number = builder_.defaultMaterial();
    } else {
        Material m = obj::materialOf(stated(*scene_.mMaterials[material]), builder_, pictures_);
        made.wantsTangents = m.principled.anisotropy > 0 ||
                             std::ranges::any_of(m.textures, [](const TextureUse& use) {
                                 return use.slot == TextureSlot::Normal;
                             });
        made.number = builder_.addMaterial(std::move(m));
    }
    return made_.emplace(material, made).first->second;
}

/// The picture of the file that a name stands for: "*N" for the N-th, or the name that it had as a
/// file; null if there is none.
const aiTexture* Materials::embedded(const std::string& name) const {
    const auto baseName = [](const std::string& path) {
        const size_t slash = path.find_last_of("/\\");
        return slash == std::string::npos ? path : path.substr(slash + 1);
    };
    for (unsigned i = 0; i < scene_.mNumTextures; ++i) {
        const aiTexture* t = scene_.mTextures[i];
        const std::string file = t->mFilename.C_Str();
        if (name == fmt::format("*{}", i)) return t;
        if (!file.empty() && baseName(file) == baseName(name)) return t;
    }
    return nullptr;
}

std::optional<obj::Map> Materials::map(const aiMaterial& m, aiTextureType type) {
    const std::string name = text(m, AI_MATKEY_TEXTURE(type, 0));
    if (name.empty()) return std::nullopt;
    obj::Map map;
    map.place = {file_, 0, "material"};
    map.name = name;
    if (const aiTexture* inside = embedded(name)) {
        // Textures with a width in bytes and no height are files; others are bare texels.
        if (inside->mHeight != 0 || inside->mWidth == 0) {
            builder_.report().ignore("bare texels in the file", "surfaces are shown without them");
            return std::nullopt;
        }
        map.content = {reinterpret_cast<const char*>(inside->pcData), inside->mWidth};
    }
    map.clamp = clamps(m, type);
    return map;
}

obj::MtlMaterial Materials::stated(const aiMaterial& m) {
    obj::MtlMaterial s;
    s.place = {file_, 0, "material"};
    s.name = text(m, AI_MATKEY_NAME);
    s.diffuse = color(m, AI_MATKEY_BASE_COLOR);
    if (!s.diffuse) s.diffuse = color(m, AI_MATKEY_COLOR_DIFFUSE);
    s.specular = color(m, AI_MATKEY_COLOR_SPECULAR);
    s.emission = color(m, AI_MATKEY_COLOR_EMISSIVE);
    s.exponent = number(m, AI_MATKEY_SHININESS);
    s.ior = number(m, AI_MATKEY_REFRACTI);
    s.dissolve = number(m, AI_MATKEY_OPACITY);
    s.roughness = number(m, AI_MATKEY_ROUGHNESS_FACTOR);
    s.metallic = number(m, AI_MATKEY_METALLIC_FACTOR);
    if (!s.metallic && reflectsAsMetal_) s.metallic = number(m, AI_MATKEY_REFLECTIVITY);
    s.diffuseMap = map(m, aiTextureType_BASE_COLOR);
    if (!s.diffuseMap) s.diffuseMap = map(m, aiTextureType_DIFFUSE);
    s.emissionMap = map(m, aiTextureType_EMISSIVE);
    s.opacityMap = map(m, aiTextureType_OPACITY);
    s.normalMap = map(m, aiTextureType_NORMALS);
    s.roughnessMap = map(m, aiTextureType_DIFFUSE_ROUGHNESS);
    s.metallicMap = map(m, aiTextureType_METALNESS);
    // Assimp's importers leave opacity at 0 where a file does not know it.
    if (s.dissolve && *s.dissolve <= 0) {
        s.dissolve.reset();
        builder_.report().forgive(s.place, "a material has opacity 0", "it is taken for opaque");
    }
    return s;
}

} // namespace stromboli::assimp
