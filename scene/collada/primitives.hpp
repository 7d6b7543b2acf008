#pragma once

#include "scene/collada/context.hpp"
#include "scene/collada/mesh.hpp"

#include <map>

namespace stromboli::collada {

/// Reads the children of one <mesh>. Throws SceneError for indices out of range, counts that
/// disagree, and a mesh without positions.
class MeshReader {
  public:
    explicit MeshReader(Context& context) : context_(context) {}

    Mesh read(const Element& meshElement);

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
    void readTriangles(const Element& primitive, const Inputs& inputs, PrimitiveGroup& group);
    void readPolylist(const Element& primitive, const Inputs& inputs, PrimitiveGroup& group);
    void readPolygons(const Element& primitive, const Inputs& inputs, PrimitiveGroup& group);
    void readStrips(const Element& primitive, const Inputs& inputs, PrimitiveGroup& group);
    void readFans(const Element& primitive, const Inputs& inputs, PrimitiveGroup& group);
    void addPolygon(const Corner* corners, size_t count, PrimitiveGroup& group);
    void checkCount(const Element& primitive, size_t found) const;

    Context& context_;
    Mesh mesh_;
    const Element* vertices_ = nullptr;
    std::map<const Element*, NormalRange> normalRanges_; ///< by <source>
    const Element* vertexNormals_ = nullptr;             ///< the NORMAL input of <vertices>
    std::vector<glm::dvec3> polygon_;                    ///< scratch of addPolygon
    std::vector<std::array<uint32_t, 3>> pieces_;        ///< scratch of addPolygon
};

} // namespace stromboli::collada
