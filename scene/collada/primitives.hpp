#pragma once

#include "scene/build/mesh.hpp"
#include "scene/build/polygon.hpp"
#include "scene/collada/context.hpp"
#include "scene/collada/corner_attributes.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace stromboli::collada {

using build::Corner, build::Mesh, build::MeshPart;

/// A part of a <mesh>, and what a material is bound to it by.
struct Primitive {
    const Element* element = nullptr;
    std::string symbol;                    ///< of its material; empty where it names none
    std::vector<const Element*> texcoords; ///< its inputs of texture coordinates, in file order
};

/// The parts of a <mesh> that are surfaces.
std::vector<Primitive> primitivesOf(const Element& meshElement);

/// Reads the children of one <mesh>. Throws SceneError for indices out of range, counts that
/// disagree, and a mesh without positions.
class MeshReader {
  public:
    explicit MeshReader(Context& context)
        : context_(context), polygons_(mesh_, context.report),
          attributes_(context, mesh_.attributes) {}

    /// `texcoords`: for each of primitivesOf(), the inputs that the textures of its material use.
    Mesh read(const Element& meshElement, std::span<const TexcoordInputs> texcoords);

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
    void reportUnused(const Element& input, const TexcoordInputs& used) const;
    NormalRange normalsOf(const Element& input);
    Inputs readInputs(const Element& primitive, const TexcoordInputs& texcoords);
    std::vector<Corner> readCorners(const Element& p, const Inputs& inputs);

    void readPrimitive(const Element& primitive, const TexcoordInputs& texcoords);
    void readTriangles(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readPolylist(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readPolygons(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readStrips(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void readFans(const Element& primitive, const Inputs& inputs, MeshPart& part);
    void checkCount(const Element& primitive, size_t found) const;

    Context& context_;
    Mesh mesh_;
    const Element* vertices_ = nullptr;
    std::map<const Element*, NormalRange> normalRanges_; ///< by <source>
    const Element* vertexNormals_ = nullptr;             ///< the NORMAL input of <vertices>
    std::vector<const Element*> vertexOthers_;           ///< its inputs without a use by positions
    build::PolygonCutter polygons_;
    CornerAttributes attributes_;
};

} // namespace stromboli::collada
