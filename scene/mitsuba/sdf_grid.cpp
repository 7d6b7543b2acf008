#include "scene/mitsuba/sdf_grid.hpp"

#include "scene/build/read_file.hpp"
#include "scene/mitsuba/volumes.hpp"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

namespace stromboli::mitsuba {
namespace {

/// Cuts each cell into six tetrahedra about its diagonal, which fit those of its neighbours, and
/// each of these by the plane on which the distance is 0.
class SurfaceOfDistances {
  public:
    explicit SurfaceOfDistances(const DensityGrid& grid) : grid_(grid) {
        mesh_.parts.emplace_back();
    }

    build::Mesh mesh() && {
        // Corner numbers have x in their first bit, y in their second and z in their third.
        constexpr std::array<std::array<uint32_t, 4>, 6> kTetrahedra = {
            {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};
        const glm::uvec3 size = grid_.size;
        for (uint32_t z = 0; z + 1 < size.z; ++z)
            for (uint32_t y = 0; y + 1 < size.y; ++y)
                for (uint32_t x = 0; x + 1 < size.x; ++x)
                    for (const auto& corners : kTetrahedra) {
                        std::array<glm::uvec3, 4> places;
                        for (size_t i = 0; i < 4; ++i)
                            places[i] =
                                glm::uvec3(x, y, z) +
                                glm::uvec3(corners[i] & 1, corners[i] >> 1 & 1, corners[i] >> 2);
                        cut(places);
                    }
        return std::move(mesh_);
    }

  private:
    size_t numberOf(const glm::uvec3& p) const {
        return (size_t(p.z) * grid_.size.y + p.y) * grid_.size.x + p.x;
    }
    double at(const glm::uvec3& p) const { return double(grid_.values[numberOf(p)]); }

    glm::dvec3 positionOf(const glm::uvec3& p) const {
        return glm::dvec3(p) / glm::dvec3(grid_.size - 1u);
    }

    glm::dvec3 gradientAt(const glm::uvec3& p) const {
        glm::dvec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            glm::uvec3 before = p, after = p;
            before[axis] = p[axis] > 0 ? p[axis] - 1 : 0;
            after[axis] = std::min(p[axis] + 1, grid_.size[axis] - 1);
            gradient[axis] =
                (at(after) - at(before)) / (positionOf(after)[axis] - positionOf(before)[axis]);
        }
        return gradient;
    }

    /// The corner of the mesh on the edge between two places of the grid.
    uint32_t between(glm::uvec3 a, glm::uvec3 b) {
        if (numberOf(b) < numberOf(a)) std::swap(a, b);
        const size_t all = size_t(grid_.size.x) * grid_.size.y * grid_.size.z;
        const auto [found, isNew] =
            corners_.try_emplace(numberOf(a) * all + numberOf(b), uint32_t(mesh_.positions.size()));
        if (isNew) {
            const double share = at(a) / (at(a) - at(b));
            mesh_.positions.push_back(glm::mix(positionOf(a), positionOf(b), share));
            mesh_.normals.push_back(glm::mix(gradientAt(a), gradientAt(b), share));
        }
        return found->second;
    }

    void cut(const std::array<glm::uvec3, 4>& places) {
        std::array<glm::uvec3, 4> sorted = places; // what is inside comes first
        const auto outside = std::stable_partition(sorted.begin(), sorted.end(),
                                                   [&](const auto& p) { return at(p) < 0; });
        const auto count = size_t(outside - sorted.begin());
        if (count == 0 || count == 4) return;
        glm::dvec3 outwards(0.0);
        for (size_t i = 0; i < 4; ++i)
            outwards += i < count ? -positionOf(sorted[i]) / double(count)
                                  : positionOf(sorted[i]) / double(4 - count);
        const auto corner = [&](size_t i, size_t j) { return between(sorted[i], sorted[j]); };
        if (count == 1) return add({corner(0, 1), corner(0, 2), corner(0, 3)}, outwards);
        if (count == 3) return add({corner(0, 3), corner(1, 3), corner(2, 3)}, outwards);
        const uint32_t a = corner(0, 2), b = corner(0, 3), c = corner(1, 3), d = corner(1, 2);
        add({a, b, c}, outwards);
        add({a, c, d}, outwards);
    }

    void add(std::array<uint32_t, 3> n, const glm::dvec3& outwards) {
        const std::vector<glm::dvec3>& p = mesh_.positions;
        const glm::dvec3 normal = glm::cross(p[n[1]] - p[n[0]], p[n[2]] - p[n[0]]);
        if (glm::dot(normal, outwards) < 0) std::swap(n[1], n[2]);
        build::MeshTriangle& triangle = mesh_.parts.front().emplace_back();
        for (size_t i = 0; i < 3; ++i)
            triangle[i] = {n[i], n[i], kNoAttributes};
    }

    const DensityGrid& grid_;
    build::Mesh mesh_;
    std::unordered_map<uint64_t, uint32_t> corners_; ///< by the two ends of their edge
};

} // namespace

build::Mesh sdfGridMesh(const Context& context, const Plugin& shape) {
    const std::string file = context.document.file(shape, "filename").string();
    const VolumeFile volume = parseVolume(build::readFile(file), file, true);
    shape.skip("normals");
    if (glm::any(glm::lessThan(volume.grid.size, glm::uvec3(2))))
        shape.fail("has a grid of one value along an axis, expected two or more");
    build::Mesh mesh = SurfaceOfDistances(volume.grid).mesh();
    if (mesh.positions.empty())
        shape.fail("has a grid of distances that are nowhere 0, so that there is no surface");
    return mesh;
}

} // namespace stromboli::mitsuba
