#include "scene/assimp/load_assimp.hpp"

#include "host/core/error.hpp"
#include "scene/assimp/assimp_api.hpp"
#include "scene/assimp/materials.hpp"
#include "scene/assimp/meshes.hpp"
#include "scene/assimp/stl_file.hpp"
#include "scene/assimp/views.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/scene_builder.hpp"

#include <assimp/postprocess.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli {
namespace assimp {
namespace {

using Imported = std::unique_ptr<const aiScene, decltype(&::aiReleaseImport)>;

/// In small letters, with its dot.
std::string endingOf(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return ending;
}

bool hasColors(const aiScene& scene) {
    return std::any_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes,
                       [](const aiMesh* mesh) { return mesh->HasVertexColors(0); });
}

/// The header ends in the version, in three digits; files of later versions may be packed, and
/// begin otherwise since version 5.
bool isOfLateBlender(std::string_view beginning) {
    constexpr std::string_view zstd = "\x28\xB5\x2F\xFD", magic = "BLENDER";
    constexpr size_t at = 9, digits = 3;
    if (beginning.starts_with(zstd)) return true;
    if (!beginning.starts_with(magic) || beginning.size() < at + digits) return false;
    const std::string_view version = beginning.substr(at, digits);
    const bool isNumber = std::ranges::all_of(version, [](char c) { return c >= '0' && c <= '9'; });
    return !isNumber || version > "279";
}

struct File {
    Imported scene;
    std::optional<glm::vec3> color; ///< of all surfaces, where an STL file states it
};

File import(const std::filesystem::path& file, build::Report& report) {
    const AssimpApi& api = assimpApi();
    if (!api.missing.empty())
        throw SceneError(file.string(), 0, "",
                         "is in a format that Assimp reads, but " + api.missing);
    const std::string beginning = build::readFile(file, 64);
    // Assimp's readers end the program where a file is empty.
    if (beginning.empty()) throw SceneError(file.string(), 0, "", "is empty: expected a scene");
    if (endingOf(file) == ".blend" && isOfLateBlender(beginning))
        throw SceneError(file.string(), 0, "",
                         "is of Blender 2.80 or later, and Assimp reads files up to 2.79: expected "
                         "what Blender exports of it, such as glTF 2.0 (.glb)");
    constexpr unsigned kSteps = aiProcess_Triangulate | aiProcess_SortByPType;
    File found{{nullptr, api.releaseImport}, std::nullopt};
    if (endingOf(file) == ".stl") {
        const StlFile stl = stlForAssimp(build::readFile(file), file.string(), report);
        constexpr size_t most = std::numeric_limits<unsigned>::max();
        if (stl.bytes.size() > most)
            throw SceneError(file.string(), 0, "", "has more than 4 GiB, which Assimp cannot read");
        found.scene.reset(
            api.importMemory(stl.bytes.data(), unsigned(stl.bytes.size()), kSteps, "stl"));
        found.color = stl.color;
    } else {
        found.scene.reset(api.importFile(file.c_str(), kSteps));
    }
    if (!found.scene)
        throw SceneError(file.string(), 0, "", std::string("Assimp: ") + api.errorString());
    // Vertices that differ by their colours alone would be joined, too.
    if (!hasColors(*found.scene) &&
        !api.applySteps(found.scene.get(), aiProcess_JoinIdenticalVertices)) {
        static_cast<void>(found.scene.release()); // Assimp has done so
        throw SceneError(file.string(), 0, "", std::string("Assimp: ") + api.errorString());
    }
    return found;
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
    Nodes(const std::filesystem::path& file, const aiScene& scene, std::optional<glm::vec3> color,
          double unit, build::SceneBuilder& builder)
        : file_(file.string()), scene_(scene), unit_(unit), isFbx_(endingOf(file) == ".fbx"),
          builder_(builder), materials_(file, scene, color, builder),
          meshes_(scene, builder, materials_) {}

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
    build::SceneBuilder builder(file.string(), conventions);
    const assimp::File read = assimp::import(file, builder.report());
    const assimp::Imported& imported = read.scene;
    if (imported->mNumAnimations > 0)
        builder.report().ignore("animations", "the scene is shown without them");
    const double unit = conventions.applyUnit ? assimp::unitOf(*imported) : 1;
    if (assimp::endingOf(file) == ".stl" && conventions.up == UpAxis::Y)
        builder.report().assume("an STL file does not say which axis is up: y is (--up z: z)");
    assimp::Nodes(file, *imported, read.color, unit, builder).place();
    return builder.finish();
}

} // namespace stromboli
