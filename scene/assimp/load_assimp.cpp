#include "scene/assimp/load_assimp.hpp"

#include "host/core/error.hpp"
#include "scene/assimp/assimp_api.hpp"
#include "scene/assimp/materials.hpp"
#include "scene/assimp/meshes.hpp"
#include "scene/assimp/views.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/scene_builder.hpp"

#include <assimp/postprocess.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string_view>

namespace stromboli {
namespace assimp {
namespace {

using Imported = std::unique_ptr<const aiScene, decltype(&::aiReleaseImport)>;

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// In small letters, with its dot.
std::string endingOf(const std::filesystem::path& file) {
    return lowered(file.extension().string());
}

Imported import(const std::filesystem::path& file) {
    const AssimpApi& api = assimpApi();
    if (!api.missing.empty())
        throw SceneError(file.string(), 0, "",
                         "is in a format that Assimp reads, but " + api.missing);
    build::readFile(file, 1); // it is there, and a file
    constexpr unsigned kSteps =
        aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_JoinIdenticalVertices;
    Imported scene(api.importFile(file.c_str(), kSteps), api.releaseImport);
    // Assimp reads the keywords of STL as text in small letters only.
    if (!scene && endingOf(file) == ".stl") {
        const std::string text = lowered(build::readFile(file));
        scene.reset(api.importMemory(text.data(), unsigned(text.size()), kSteps, "stl"));
    }
    if (!scene) throw SceneError(file.string(), 0, "", std::string("Assimp: ") + api.errorString());
    return scene;
}

glm::dmat4 matrixOf(const aiMatrix4x4& m) {
    return {glm::dvec4(m.a1, m.b1, m.c1, m.d1), glm::dvec4(m.a2, m.b2, m.c2, m.d2),
            glm::dvec4(m.a3, m.b3, m.c3, m.d3), glm::dvec4(m.a4, m.b4, m.c4, m.d4)};
}

/// Metres of one of the file's units: FBX states centimetres; elsewhere a unit is a metre.
double unitOf(const aiScene& scene) {
    double centimetres = 0;
    const aiMetadata* data = scene.mMetaData;
    for (unsigned i = 0; data && i < data->mNumProperties; ++i) {
        if (std::string_view(data->mKeys[i].C_Str()) != "UnitScaleFactor") continue;
        const aiMetadataEntry& entry = data->mValues[i];
        if (entry.mType == AI_DOUBLE) centimetres = *static_cast<const double*>(entry.mData);
        if (entry.mType == AI_FLOAT) centimetres = double(*static_cast<const float*>(entry.mData));
    }
    return centimetres > 0 ? centimetres / 100 : 1;
}

/// Puts all that hangs on nodes into the world.
class Nodes {
  public:
    Nodes(const std::filesystem::path& file, const aiScene& scene, double unit,
          build::SceneBuilder& builder)
        : file_(file.string()), scene_(scene), unit_(unit), isFbx_(endingOf(file) == ".fbx"),
          builder_(builder), materials_(file, scene, builder), meshes_(scene, builder, materials_) {
    }

    void place() {
        struct Pending {
            const aiNode* node;
            glm::dmat4 parent;
        };
        glm::dmat4 toMetres(unit_);
        toMetres[3][3] = 1;
        std::vector<Pending> pending{{scene_.mRootNode, toMetres}};
        while (!pending.empty()) {
            const Pending next = pending.back();
            pending.pop_back();
            if (!next.node) continue;
            const glm::dmat4 matrix = next.parent * matrixOf(next.node->mTransformation);
            place(*next.node, matrix);
            for (unsigned i = next.node->mNumChildren; i-- > 0;)
                pending.push_back({next.node->mChildren[i], matrix});
        }
    }

  private:
    void place(const aiNode& node, const glm::dmat4& matrix) {
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            const unsigned mesh = node.mMeshes[i];
            if (mesh >= scene_.mNumMeshes) continue;
            const std::optional<build::ShapeId> shape = meshes_.shapeOf(mesh);
            if (!shape) continue;
            builder_.place({file_, 0, "node"}, *shape, matrix, std::array{meshes_.materialOf(mesh)},
                           node.mName.C_Str());
        }
        const std::string_view name = node.mName.C_Str();
        for (unsigned i = 0; i < scene_.mNumLights; ++i)
            if (name == scene_.mLights[i]->mName.C_Str())
                placeLight(*scene_.mLights[i], matrix, unit_, isFbx_, builder_);
        for (unsigned i = 0; i < scene_.mNumCameras; ++i)
            if (name == scene_.mCameras[i]->mName.C_Str())
                placeCamera(*scene_.mCameras[i], matrix, builder_);
    }

    std::string file_;
    const aiScene& scene_;
    double unit_; ///< metres
    bool isFbx_;
    build::SceneBuilder& builder_;
    Materials materials_;
    Meshes meshes_;
};

} // namespace
} // namespace assimp

Scene loadWithAssimp(const std::filesystem::path& file, const SceneConventions& conventions) {
    const assimp::Imported imported = assimp::import(file);
    build::SceneBuilder builder(file.string(), conventions);
    if (imported->mNumAnimations > 0)
        builder.report().ignore("animations", "the scene is shown without them");
    const double unit = conventions.applyUnit ? assimp::unitOf(*imported) : 1;
    if (assimp::endingOf(file) == ".stl" && conventions.up == UpAxis::Y)
        builder.report().assume("an STL file does not say which axis is up: y is (--up z: z)");
    assimp::Nodes(file, *imported, unit, builder).place();
    return builder.finish();
}

} // namespace stromboli
