#include "scene/collada/placement.hpp"

#include "scene/collada/cs184_normals.hpp"
#include "scene/collada/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stromboli::collada {
namespace {

/// More triangles than this do not fit in the scene's 32-bit corner numbers with room to spare.
constexpr size_t kMostTriangles = size_t(1) << 28;

/// Transforms normals: the inverse transpose up to a positive factor. As the cofactors it exists
/// for singular matrices too, such as those that flatten a mesh.
glm::dmat3 normalTransform(const glm::dmat4& toWorld) {
    glm::dmat3 m(toWorld);
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(m[column][row]));
    if (largest > 0) m /= largest; // or the products below could overflow
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]),
                               glm::cross(m[0], m[1]));
    return glm::determinant(m) < 0 ? -cofactors : cofactors;
}

/// True if three unit normals say no more than the triangle's own, g (unit). Files carry six
/// digits or more: numbers are off by up to 2^-20 of themselves (single precision is better). That
/// much tilts a normal by up to 2 * 2^-20, and moves two corners apart by up to 4 times 2^-20 of
/// the largest coordinate, which tilts the triangle by that over its least height.
bool isFlat(const glm::dvec3 normals[3], const glm::dvec3& g, const glm::dvec3 points[3],
            double twiceArea) {
    constexpr double rounding = 0x1p-20;
    double coordinate = 0, longest = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 size = glm::abs(points[i]);
        coordinate = std::max({coordinate, size.x, size.y, size.z});
        longest = std::max(longest, glm::distance(points[i], points[(i + 1) % 3]));
    }
    const double tilt = rounding * (2 + 4 * coordinate * longest / twiceArea);
    // A triangle so thin that its own normal is no better than this keeps those of the file.
    if (!(tilt < 0x1p-10)) return false;
    for (int i = 0; i < 3; ++i)
        if (!(glm::distance(normals[i], g) <= tilt)) return false;
    return true;
}

/// Adds the triangles of one mesh, and of its positions and normals those they use.
class MeshPlacer {
  public:
    MeshPlacer(Context& context, const Mesh& mesh, const glm::dmat4& toWorld, Drops& drops)
        : scene_(context.scene), drops_(drops), cs184_(context.options.cs184),
          mirrored_(!cs184_ && glm::determinant(glm::dmat3(toWorld)) < 0) {
        std::vector<glm::dvec3> exact;
        for (const glm::dvec3& p : mesh.positions)
            exact.push_back(glm::dvec3(toWorld * glm::dvec4(p, 1)));
        points_.assign(exact.begin(), exact.end());
        if (cs184_) {
            normals_ = cs184VertexNormals(exact, mesh.groups);
        } else {
            const glm::dmat3 transform = normalTransform(toWorld);
            for (const glm::dvec3& n : mesh.normals)
                normals_.push_back(transform * unit(n).value_or(glm::dvec3(0)));
        }
        for (glm::dvec3& n : normals_)
            n = unit(n).value_or(glm::dvec3(0));
        scenePosition_.assign(points_.size(), kUnused);
        sceneNormal_.assign(normals_.size(), kUnused);
    }

    void add(MeshTriangle corners, uint32_t material, uint32_t instance) {
        ++drops_.triangles;
        if (cs184_)
            for (Corner& corner : corners)
                corner.normal = corner.position;
        if (mirrored_) std::swap(corners[1], corners[2]);

        glm::dvec3 points[3];
        for (int i = 0; i < 3; ++i) {
            points[i] = points_[corners[i].position];
            if (!inRange(points[i])) return void(++drops_.outOfRange);
        }
        const glm::dvec3 cross = glm::cross(points[1] - points[0], points[2] - points[0]);
        const std::optional<glm::dvec3> g = unit(cross);
        if (!g) return void(++drops_.zeroArea);

        Triangle triangle;
        triangle.material = material;
        triangle.instance = instance;
        const bool useNormals = chooseNormals(corners, points, *g, glm::length(cross));
        for (int i = 0; i < 3; ++i) {
            triangle.corner[i] = positionIndex(corners[i].position);
            if (useNormals) triangle.normals[i] = normalIndex(corners[i].normal);
        }
        scene_.triangles.push_back(triangle);
    }

  private:
    static constexpr uint32_t kUnused = 0xFFFFFFFFu;

    /// Turns the triangle to the side of its normals. False if it needs none: the file has none
    /// (a polygon without normals is plane, so it is shaded with its geometric one), they are no
    /// use, or they are the geometric one.
    bool chooseNormals(MeshTriangle& corners, const glm::dvec3 points[3], glm::dvec3 g,
                       double twiceArea) {
        if (corners[0].normal == kNoNormals) return false;
        glm::dvec3 normals[3], sum(0);
        for (int i = 0; i < 3; ++i) {
            normals[i] = normals_[corners[i].normal];
            if (normals[i] == glm::dvec3(0)) {
                ++drops_.badNormals;
                return false;
            }
            sum += normals[i];
        }
        if (cs184_) return true;
        if (glm::dot(sum, g) < 0) {
            std::swap(corners[1], corners[2]);
            g = -g;
        }
        return !isFlat(normals, g, points, twiceArea);
    }

    uint32_t positionIndex(uint32_t index) {
        uint32_t& place = scenePosition_[index];
        if (place == kUnused) {
            place = uint32_t(scene_.positions.size());
            scene_.positions.push_back(points_[index]);
        }
        return place;
    }

    uint32_t normalIndex(uint32_t index) {
        uint32_t& place = sceneNormal_[index];
        if (place == kUnused) {
            place = uint32_t(scene_.normals.size());
            scene_.normals.emplace_back(normals_[index]);
        }
        return place;
    }

    Scene& scene_;
    Drops& drops_;
    bool cs184_, mirrored_;
    /// What the renderer will see. Rounded in memory once: g++ 12 drops the rounding of a vector of
    /// doubles to float and back within one expression (-ftree-slp-vectorize).
    std::vector<glm::vec3> points_;
    std::vector<glm::dvec3> normals_; ///< unit, or zero where there is none
    std::vector<uint32_t> scenePosition_, sceneNormal_;
};

} // namespace

void Drops::reportTo(Report& report, const std::string& geometry) const {
    if (zeroArea + outOfRange > 0)
        report.warn(fmt::format("mesh '{}': {} of {} triangles left out: {} of zero area, {} not "
                                "finite or beyond 2^60",
                                geometry, zeroArea + outOfRange, triangles, zeroArea, outOfRange));
    if (badNormals > 0)
        report.warn(fmt::format("mesh '{}': {} of {} triangles have zero or non-finite normals and "
                                "are shaded flat",
                                geometry, badNormals, triangles));
    if (spheres > 0)
        report.warn(fmt::format("sphere '{}': {} left out: radius not greater than 0, not finite "
                                "or beyond 2^60",
                                geometry, spheres));
}

void placeMesh(Context& context, const Element& where, const Mesh& mesh, const glm::dmat4& toWorld,
               std::span<const uint32_t> materials, const std::string& instanceName, Drops& drops) {
    size_t count = context.scene.triangles.size();
    for (const PrimitiveGroup& group : mesh.groups)
        count += group.triangles.size();
    if (count > kMostTriangles)
        context.document.fail(where, fmt::format("brings the scene to {} triangles, more than the "
                                                 "{} there is room for",
                                                 count, kMostTriangles));
    const auto instance = uint32_t(context.scene.instances.size());
    context.scene.instances.push_back(instanceName);
    MeshPlacer placer(context, mesh, toWorld, drops);
    for (size_t i = 0; i < mesh.groups.size(); ++i)
        for (const MeshTriangle& triangle : mesh.groups[i].triangles)
            placer.add(triangle, materials[i], instance);
}

void placeSphere(Context& context, double radius, const glm::dmat4& toWorld, uint32_t material,
                 const std::string& instanceName, Drops& drops) {
    const glm::dvec3 scale(glm::length(glm::dvec3(toWorld[0])), glm::length(glm::dvec3(toWorld[1])),
                           glm::length(glm::dvec3(toWorld[2])));
    const glm::dvec3 center = toWorld[3];
    const double worldRadius = radius * scale.x;
    const bool fits =
        float(worldRadius) > 0 && inRange(center + worldRadius) && inRange(center - worldRadius);
    if (!fits) return void(++drops.spheres);
    // Files carry about six digits: what is less apart was meant to be equal.
    if (std::max({scale.x, scale.y, scale.z}) > 1.0001 * std::min({scale.x, scale.y, scale.z}))
        context.report.warn(fmt::format("sphere '{}': scaled unequally; it stays a sphere with the "
                                        "scale of its x axis",
                                        instanceName));
    Sphere sphere;
    sphere.center = center;
    sphere.radius = float(worldRadius);
    sphere.material = material;
    sphere.instance = uint32_t(context.scene.instances.size());
    context.scene.instances.push_back(instanceName);
    context.scene.spheres.push_back(sphere);
}

} // namespace stromboli::collada
