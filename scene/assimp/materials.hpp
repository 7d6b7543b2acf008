#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/obj/mtl_file.hpp"
#include "scene/obj/pictures.hpp"

#include <assimp/scene.h>

#include <filesystem>
#include <map>
#include <optional>

namespace stromboli::assimp {

/// The materials of a file, each made when a mesh first has it, by the rules that those of OBJ
/// files have (scene/obj/material_rules.hpp).
class Materials {
  public:
    /// color: of surfaces of formats that have no materials.
    Materials(const std::filesystem::path& file, const aiScene& scene,
              std::optional<glm::vec3> color, build::SceneBuilder& builder);

    uint32_t numberOf(unsigned material);
    /// Its surface has a direction: a normal map, or a grain.
    bool wantsTangents(unsigned material);

  private:
    struct Made {
        uint32_t number = 0;
        bool wantsTangents = false;
    };

    const Made& made(unsigned material);
    obj::MtlMaterial stated(const aiMaterial& material);
    const aiTexture* embedded(const std::string& name) const;
    std::optional<obj::Map> map(const aiMaterial& material, aiTextureType type);

    std::string file_;
    const aiScene& scene_;
    std::optional<glm::vec3> color_;
    build::SceneBuilder& builder_;
    obj::Pictures pictures_;
    std::map<unsigned, Made> made_;
    bool isWithoutMaterials_ = false; ///< the format (STL) has none
    bool reflectsAsMetal_ = false;    ///< what it reflects is the share of metal (Blender's FBX)
    bool hasColors_ = false;          ///< some corners
};

} // namespace stromboli::assimp
