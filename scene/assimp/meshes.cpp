#include "scene/assimp/meshes.hpp"

#include "scene/assimp/vectors.hpp"
#include "scene/build/tangents.hpp"
#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::assimp {
namespace {

float finite(float x) {
    return std::isfinite(x) ? x : 0.0f;
}

/// What colours are divided by: OFF files of many programs have bytes.
float mostOfColors(const aiMesh& mesh) {
    if (!mesh.HasVertexColors(0)) return 1;
    float most = 0;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiColor4D& c = mesh.mColors[0][i];
        most = std::max({most, finite(c.r), finite(c.g), finite(c.b)});
    }
    return most > 1 && most <= 255 ? 255.0f : 1.0f;
}

/// Colours are a screen's, as those of OBJ and PLY files.
float linearOf(float color, float most) {
    return float(srgbToLinear(double(finite(color) / most)));
}

/// Beside colours of bytes there are programs that write 1 and such that write 255.
float opacityOf(float alpha) {
    return alpha > 1 ? std::min(alpha / 255, 1.0f) : finite(alpha);
}

/// Assimp's v grows upwards.
VertexAttributes attributesOf(const aiMesh& mesh, unsigned vertex, float mostOfColors) {
    VertexAttributes a;
    for (unsigned set = 0; set < 2; ++set)
        if (mesh.HasTextureCoords(set)) {
            const aiVector3D& uv = mesh.mTextureCoords[set][vertex];
            a.uv[set] = {finite(uv.x), finite(1 - uv.y)};
        }
    if (mesh.HasVertexColors(0)) {
        const aiColor4D& c = mesh.mColors[0][vertex];
        a.color = {linearOf(c.r, mostOfColors), linearOf(c.g, mostOfColors),
                   linearOf(c.b, mostOfColors), opacityOf(c.a)};
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
    const float most = mostOfColors(mesh);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        made.positions.push_back(vectorOf(mesh.mVertices[i]));
        if (mesh.HasNormals()) made.normals.push_back(vectorOf(mesh.mNormals[i]));
        if (hasAttributes) made.attributes.push_back(attributesOf(mesh, i, most));
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
