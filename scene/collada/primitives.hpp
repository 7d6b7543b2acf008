#pragma once

#include "scene/build/mesh.hpp"
#include "scene/build/polygon.hpp"
#include "scene/collada/context.hpp"

#include <map>
#include <string>
#include <vector>

namespace stromboli::collada {

using build::Corner, build::Mesh, build::MeshPart;

/// A <mesh> and, for each of its parts, the symbol of its material (empty where it names none).
struct ColladaMesh {
    Mesh mesh;
    std::vector<std::string> symbols;
};

/// Reads the children of one <mesh>. Throws SceneError for indices out of range, counts that
/// disagree, and a mesh without positions.
class MeshReader {
  public:
    explicit MeshReader(Context& context) : context_(context), polygons_(mesh_, context.report) {}

    ColladaMesh read(const Element& meshElement);

  private:
    /// The vectors of one NORMAL source within Mesh::normals.
    struct NormalRange {
        uint32_t first = 0, count = 0;
    };
    /// Where a primitive's <p> holds what.
    struct Inputs {
        uint32_t stride = 1;
        uint32_t vertexOffset = 0, normalOffset = 0;
        bool hasNormals = false;
        NormalRange normals;
    };

    void readVertices(const Element& meshElement);
    NormalRange normalsOf(const Element& input);
    Inputs readInputs(const Element& primitive);
    std::vector<Corner> readCorners(const Element& p, const Inputs& inputs);

    void readPrimitive(const Element& primitive);
    void readTriangles(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readPolylist(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readPolygons(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readStrips(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readFans(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void checkCount(const Element& primitive, size_t found) const;

    Context& context_;
    Mesh mesh_;
    std::vector<std::string> symbols_;
    const Element* vertices_ = nullptr;
    std::map<const Element*, NormalRange> normalRanges_; ///< by <source>
    const Element* vertexNormals_ = nullptr;             ///< the NORMAL input of <vertices>
    build::PolygonCutter polygons_;
};

} // namespace stromboli::collada
