#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/ply/body.hpp"
#include "scene/ply/face_colors.hpp"
#include "scene/ply/load_ply.hpp"
#include "scene/ply/vertices.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::ply {

/// Reads a PLY file and hands the builder the mesh that it is.
class PlyReader {
  public:
    PlyReader(const std::filesystem::path& file, build::SceneBuilder& builder,
              const PlyAttribute& colors);
    void read();

  private:
    void readAll();
    void requireFaces() const;
    void readElements(const Element& stated);
    void readFaces(const Element& element);
    void skip(const Element& element);
    void addStrip(const std::vector<uint32_t>& strip);
    uint32_t vertex(double index);
    bool readsFaceColors(const FaceColors& colors) const;
    void readCornerUvs(const Property& property, size_t corners);
    build::Corner cornerOf(size_t face, size_t corner, bool hasAttributes, build::Mesh& mesh) const;
    build::Mesh makeMesh();
    size_t partOf(size_t face, build::Mesh& mesh);
    std::optional<uint32_t> picture(uint32_t number);
    uint32_t material(uint32_t pictureNumber);
    std::vector<uint32_t> materialsOfParts();

    const std::filesystem::path& file_;
    std::string name_; ///< for messages
    build::SceneBuilder& builder_;
    PlyAttribute colors_;
    std::string bytes_;
    Header header_;
    Body body_;
    uint64_t vertexCount_ = 0;
    Vertices vertices_;
    std::vector<uint32_t> corners_;    ///< of all faces, one face after the other
    std::vector<uint32_t> sizes_;      ///< how many corners each of them has
    std::vector<glm::vec2> cornerUvs_; ///< of each corner, v upwards; empty: the vertices' count
    std::vector<uint32_t> pictureNumbers_; ///< of each face; empty: there are none
    std::vector<uint32_t> partPictures_;   ///< of the mesh's parts
    std::vector<glm::vec4> faceColors_;    ///< of each of them; empty: none are wanted, or there
};

} // namespace stromboli::ply
