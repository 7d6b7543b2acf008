#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/obj/materials.hpp"

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

namespace stromboli::obj {

/// Normals that the file does not state have numbers of their own.
inline constexpr uint32_t kFirstSmooth = 0x80000000u;

/// What corners of faces refer to: lists of the whole file, whatever group a face is in. Corners
/// name positions, normals, and as their attributes texture coordinates.
struct FileLists {
    build::Mesh mesh;                 ///< positions and normals
    std::vector<glm::vec2> texcoords; ///< v grows upwards
    std::vector<glm::vec3> colors;    ///< linear, one for each position; empty if none has any
    /// Those of smoothing groups, of any length; corners name them from kFirstSmooth on.
    std::vector<glm::dvec3> smoothNormals;
};

/// The faces of a file, by object, group and material.
class Groups {
  public:
    /// Faces that follow belong to this object and group (empty: none); the same names later on
    /// continue it.
    void enter(const std::string& object, const std::string& group, int line);
    /// The part of the present group with this material; nothing: no material is stated.
    build::MeshPart& part(std::optional<uint32_t> materialName);

    /// Makes each group an instance of its own; `lists` is no longer needed after that.
    void place(const std::string& file, const FileLists& lists, Materials& materials,
               build::SceneBuilder& builder);

  private:
    struct Group {
        std::string name;
        int line = 0;
        std::map<std::optional<uint32_t>, build::MeshPart> parts;
    };

    std::vector<Group> groups_;
    std::unordered_map<std::string, size_t> byName_;
    /// The name of the faces that follow; it becomes a group with the first of them.
    std::string name_ = "default";
    int line_ = 0;
};

} // namespace stromboli::obj
