#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/obj/mtl_file.hpp"
#include "scene/obj/pictures.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace stromboli::obj {

/// A material of the scene, and what it wants from the corners of its triangles.
struct BoundMaterial {
    uint32_t number = 0;
    bool isTextured = false, wantsTangents = false;
};

/// The materials that an OBJ file uses, by name. Its libraries may be named after them.
class Materials {
  public:
    Materials(const std::filesystem::path& file, build::SceneBuilder& builder);

    /// `mtllib`: one name or several.
    void addLibraries(const Statements& statement);
    /// `usemtl`: a number for the name.
    uint32_t nameNumber(const Statements& statement);

    /// The material of a name; nothing: that of surfaces without one.
    const BoundMaterial& of(std::optional<uint32_t> name);

  private:
    struct Use {
        std::string name;
        build::FilePlace place; ///< of its first usemtl
    };
    bool addLibrary(std::string_view name, const build::FilePlace& where);
    bool addMeantLibrary(std::string_view name, const build::FilePlace& where);
    std::optional<std::string> meant(const Use& use);
    void addOwnLibrary(const build::FilePlace& where);
    const BoundMaterial& unknown(uint32_t name);
    BoundMaterial make(const MtlMaterial& stated);

    std::filesystem::path folder_;
    std::string ownLibrary_; ///< named as the file is; empty: it has been looked for
    build::SceneBuilder& builder_;
    Pictures pictures_;
    std::unordered_map<std::string, MtlMaterial> stated_;
    std::vector<std::string> libraries_; ///< those that have been read
    std::vector<Use> uses_;
    std::unordered_map<std::string, uint32_t> useNumbers_;
    std::unordered_map<uint32_t, BoundMaterial> made_;
    std::optional<BoundMaterial> standard_;
};

} // namespace stromboli::obj
