#include "scene/build/mesh_uses.hpp"

#include "scene/model/placements.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace stromboli::build {
namespace {

/// A copy of fewer triangles takes no more memory than an instance: 60 bytes each (a record for two
/// of them, their normals, a part of a node) against 128 and a part of a node.
constexpr size_t kLeastTriangles = 4;

/// Automatically, copies are made of up to so many triangles: 60 MB, and a second of building the
/// tree. They are traced faster than what is shared (docs/results.md, "Instances").
constexpr uint64_t kMostCopies = uint64_t(1) << 20;

} // namespace

size_t triangleCount(const Mesh& mesh) {
    size_t count = 0;
    for (const MeshPart& part : mesh.parts)
        count += part.size();
    return count;
}

MeshUses::MeshUses(std::span<const MeshUse> uses, std::function<const Mesh&(size_t)> meshOf)
    : uses_(uses), meshOf_(std::move(meshOf)), copied_(uses.size()) {
    std::iota(copied_.begin(), copied_.end(), size_t(0));
}

std::vector<MeshUses::Shared> MeshUses::candidates(std::span<const Material> materials) const {
    using Key = std::pair<size_t, std::vector<uint32_t>>; // shape and materials
    std::map<Key, Shared> groups;
    for (size_t i = 0; i < uses_.size(); ++i) {
        const MeshUse& use = uses_[i];
        if (triangleCount(meshOf_(use.shape)) < kLeastTriangles) continue;
        if (std::ranges::any_of(use.materials, [&](uint32_t m) { return materials[m].emits(); }))
            continue;
        if (placementOf(use.toWorld)) groups[{use.shape, use.materials}].uses.push_back(i);
    }
    std::vector<Shared> several;
    for (auto& [key, group] : groups)
        if (group.uses.size() > 1) several.push_back(std::move(group));
    return several;
}

void MeshUses::share(std::span<const Material> materials, InstanceSharing sharing) {
    if (sharing == InstanceSharing::Off) return;
    std::vector<Shared> groups = candidates(materials);
    uint64_t saved = 0;
    for (const Shared& group : groups)
        saved += (group.uses.size() - 1) * triangleCount(meshOf_(uses_[group.uses[0]].shape));
    if (sharing == InstanceSharing::Automatic && saved <= kMostCopies) return;
    shared_ = std::move(groups);
    std::vector<bool> isShared(uses_.size(), false);
    for (const Shared& group : shared_)
        for (const size_t use : group.uses)
            isShared[use] = true;
    std::erase_if(copied_, [&](size_t use) { return isShared[use]; });
}

uint64_t MeshUses::copiedTriangles() const {
    uint64_t count = 0;
    for (const size_t use : copied_)
        count += triangleCount(meshOf_(uses_[use].shape));
    return count;
}

} // namespace stromboli::build
