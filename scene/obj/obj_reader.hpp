#pragma once

#include "scene/build/polygon.hpp"
#include "scene/obj/groups.hpp"
#include "scene/obj/smoothing.hpp"
#include "scene/obj/statements.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace stromboli::obj {

/// Reads the statements of an OBJ file and hands its groups to the builder.
class ObjReader {
  public:
    ObjReader(const std::filesystem::path& file, build::SceneBuilder& builder);
    void read();

  private:
    void readStatement(std::string_view keyword);
    double number(Words& words);
    glm::dvec3 readVector(Words& words, build::Shortfall kind);
    void readPosition();
    void readNormal();
    void readTexcoord();
    void readFace();
    build::Corner readCorner(std::string_view word);
    uint32_t index(std::string_view corner, std::string_view word, size_t count, const char* what);
    void makeUniform(std::vector<build::Corner>& corners);
    void useMaterial();
    void requireFaces() const;
    void readPaint();
    void takePaint();
    void finishColors();
    void requireMemory();

    const std::filesystem::path& file_;
    build::SceneBuilder& builder_;
    Statements statements_;
    FileLists lists_;
    Groups groups_;
    Materials materials_;
    build::PolygonCutter polygons_;
    Smoothing smoothing_;
    std::vector<glm::vec3> paint_; ///< of ZBrush, of the first vertices
    std::optional<build::FilePlace> firstColor_;
    std::string object_, group_;
    std::vector<build::Corner> corners_; ///< of the present face
    build::MeshPart* part_ = nullptr;    ///< null: to be looked up
    /// Number in materials_ of the present material's name.
    std::optional<uint32_t> materialName_;
    uint64_t cornersRead_ = 0;
};

} // namespace stromboli::obj
