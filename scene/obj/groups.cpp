#include "scene/obj/groups.hpp"

#include "scene/build/tangents.hpp"

#include <utility>

namespace stromboli::obj {
namespace {

constexpr uint32_t kUnused = 0xFFFFFFFFu;

/// Gives the elements of a list that a mesh uses numbers of its own, in the order of first use.
class Renumbering {
  public:
    explicit Renumbering(size_t count) : number_(count, kUnused) {}

    /// The new number of an element; it is appended to used() if it had none.
    uint32_t of(uint32_t element) {
        uint32_t& number = number_[element];
        if (number == kUnused) {
            number = uint32_t(used_.size());
            used_.push_back(element);
        }
        return number;
    }
    const std::vector<uint32_t>& used() const { return used_; }
    /// Costs what was used, not what there is: files have thousands of small groups.
    void clear() {
        for (const uint32_t element : used_)
            number_[element] = kUnused;
        used_.clear();
    }

  private:
    std::vector<uint32_t> number_, used_;
};

/// Makes meshes of groups.
class MeshMaker {
  public:
    explicit MeshMaker(const FileLists& lists)
        : lists_(lists), positions_(lists.mesh.positions.size()),
          normals_(lists.mesh.normals.size() + lists.smoothNormals.size()),
          texcoords_(lists.colors.empty() ? lists.texcoords.size() : 0) {}

    build::Mesh make(const std::map<std::optional<uint32_t>, build::MeshPart>& parts) {
        build::Mesh mesh;
        for (const auto& [material, triangles] : parts) {
            build::MeshPart& part = mesh.parts.emplace_back();
            part.reserve(triangles.size());
            for (const build::MeshTriangle& triangle : triangles) {
                build::MeshTriangle& own = part.emplace_back();
                for (size_t i = 0; i < 3; ++i)
                    own[i] = cornerOf(triangle[i], mesh);
            }
        }
        for (const uint32_t p : positions_.used())
            mesh.positions.push_back(lists_.mesh.positions[p]);
        for (const uint32_t n : normals_.used())
            mesh.normals.push_back(n < lists_.mesh.normals.size()
                                       ? lists_.mesh.normals[n]
                                       : lists_.smoothNormals[n - lists_.mesh.normals.size()]);
        positions_.clear();
        normals_.clear();
        texcoords_.clear();
        attributes_.clear();
        return mesh;
    }

  private:
    build::Corner cornerOf(const build::Corner& corner, build::Mesh& mesh) {
        return {positions_.of(corner.position),
                corner.normal == kNoNormals ? kNoNormals : normals_.of(placeOf(corner.normal)),
                attributesOf(corner, mesh)};
    }

    /// Those of smoothing groups come after those of the file.
    uint32_t placeOf(uint32_t normal) const {
        return normal < kFirstSmooth
                   ? normal
                   : uint32_t(lists_.mesh.normals.size()) + (normal - kFirstSmooth);
    }

    /// Corners have attributes where they have texture coordinates or colours.
    uint32_t attributesOf(const build::Corner& corner, build::Mesh& mesh) {
        const bool hasUv = corner.attributes != kNoAttributes;
        const bool hasColor = !lists_.colors.empty();
        if (!hasUv && !hasColor) return kNoAttributes;
        const auto next = uint32_t(mesh.attributes.size());
        uint32_t number = 0;
        if (hasColor) { // few files have any
            const uint64_t key = uint64_t(corner.attributes) << 32 | corner.position;
            number = attributes_.try_emplace(key, next).first->second;
        } else {
            number = texcoords_.of(corner.attributes);
        }
        if (number == next) {
            VertexAttributes& a = mesh.attributes.emplace_back();
            // On the renderer's pictures v grows downwards.
            if (hasUv) {
                const glm::vec2 uv = lists_.texcoords[corner.attributes];
                a.uv[0] = {uv.x, 1 - uv.y};
            }
            if (hasColor) a.color = glm::vec4(lists_.colors[corner.position], 1);
        }
        return number;
    }

    const FileLists& lists_;
    Renumbering positions_, normals_;
    Renumbering texcoords_;                             ///< of files without colours,
    std::unordered_map<uint64_t, uint32_t> attributes_; ///< and of those with
};

bool lackTexcoords(const build::MeshPart& part) {
    for (const build::MeshTriangle& triangle : part)
        if (triangle[0].attributes == kNoAttributes) return true;
    return false;
}

} // namespace

void Groups::enter(const std::string& object, const std::string& group, int line) {
    std::string name = object;
    if (!group.empty() && group != object) name += (object.empty() ? "" : "/") + group;
    if (name.empty()) name = "default";
    name_ = std::move(name);
    line_ = line;
}

build::MeshPart& Groups::part(std::optional<uint32_t> materialName) {
    const auto [found, isNew] = byName_.try_emplace(name_, groups_.size());
    if (isNew) groups_.push_back({name_, line_, {}});
    return groups_[found->second].parts[materialName];
}

void Groups::place(const std::string& file, const FileLists& lists, Materials& materials,
                   build::SceneBuilder& builder) {
    MeshMaker maker(lists);
    for (Group& group : groups_) {
        std::erase_if(group.parts, [](const auto& part) { return part.second.empty(); });
        if (group.parts.empty()) continue;
        build::Mesh mesh = maker.make(group.parts);
        std::vector<uint32_t> numbers;
        for (const auto& [name, triangles] : group.parts) {
            const BoundMaterial& material = materials.of(name);
            numbers.push_back(material.number);
            if (material.isTextured && lackTexcoords(triangles))
                builder.report().warn("faces without texture coordinates have a material with "
                                      "pictures; (0, 0) is taken");
            if (material.wantsTangents) build::computeTangents(mesh, numbers.size() - 1, 0);
        }
        group.parts.clear();
        const build::ShapeId shape = builder.addMesh(group.name, std::move(mesh));
        builder.place({file, group.line, "g"}, shape, glm::dmat4(1), numbers, group.name);
    }
}

} // namespace stromboli::obj
