#include "scene/assimp/meshes.hpp"

#include "scene/assimp/vectors.hpp"
#include "scene/build/tangents.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace stromboli::assimp {
namespace {

float finite(float x) {
    return std::isfinite(x) ? x : 0.0f;
}

/// Assimp's v grows upwards.
VertexAttributes attributesOf(const aiMesh& mesh, unsigned vertex) {
    VertexAttributes a;
    for (unsigned set = 0; set < 2; ++set)
        if (mesh.HasTextureCoords(set)) {
            const aiVector3D& uv = mesh.mTextureCoords[set][vertex];
            a.uv[set] = {finite(uv.x), finite(1 - uv.y)};
        }
    if (mesh.HasVertexColors(0)) {
        const aiColor4D& c = mesh.mColors[0][vertex];
        a.color = {finite(c.r), finite(c.g), finite(c.b), finite(c.a)};
    }
    return a;
}

} // namespace

Meshes::Meshes(const aiScene& scene, build::SceneBuilder& builder, Materials& materials)
    : scene_(scene), builder_(builder), materials_(materials), shapes_(scene.mNumMeshes) {}

uint32_t Meshes::materialOf(unsigned mesh) {
    return materials_.numberOf(scene_.mMeshes[mesh]->mMaterialIndex);
}

std::optional<build::ShapeId> Meshes::shapeOf(unsigned mesh) {
    if (!shapes_[mesh]) shapes_[mesh] = make(*scene_.mMeshes[mesh]);
    return *shapes_[mesh];
}

std::optional<build::ShapeId> Meshes::make(const aiMesh& mesh) {
    build::Report& report = builder_.report();
    if (mesh.HasBones()) report.ignore("bones", "meshes are shown as they are without them");
    if (mesh.mNumAnimMeshes > 0) report.ignore("morph targets", "meshes are shown without them");
    build::Mesh made;
    const bool hasAttributes =
        mesh.HasTextureCoords(0) || mesh.HasTextureCoords(1) || mesh.HasVertexColors(0);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        made.positions.push_back(vectorOf(mesh.mVertices[i]));
        if (mesh.HasNormals()) made.normals.push_back(vectorOf(mesh.mNormals[i]));
        if (hasAttributes) made.attributes.push_back(attributesOf(mesh, i));
    }
    build::MeshPart part;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const aiFace& face = mesh.mFaces[i];
        if (face.mNumIndices != 3) {
            report.ignore("points and lines", "are not shown");
            continue;
        }
        build::MeshTriangle triangle;
        bool isThere = true;
        for (unsigned c = 0; c < 3; ++c) {
            const unsigned index = face.mIndices[c];
            isThere = isThere && index < mesh.mNumVertices;
            triangle[c] = {index, mesh.HasNormals() ? index : kNoNormals,
                           hasAttributes ? index : kNoAttributes};
        }
        if (isThere) part.push_back(triangle);
    }
    if (part.empty()) return std::nullopt;
    made.parts.push_back(std::move(part));
    if (materials_.wantsTangents(mesh.mMaterialIndex)) build::computeTangents(made, 0, 0);
    return builder_.addMesh(mesh.mName.C_Str(), std::move(made));
}

} // namespace stromboli::assimp
