#include "scene/build/mesh_placer.hpp"

#include "scene/build/vectors.hpp"
#include "scene/build/vertex_normals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace stromboli::build {
namespace {

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

constexpr uint32_t kUnused = 0xFFFFFFFFu;

} // namespace

MeshPlacer::MeshPlacer(Scene& scene, const SceneConventions& conventions, const Mesh& mesh,
                       const glm::dmat4& toWorld, Drops& drops)
    : scene_(scene), mesh_(mesh), drops_(drops), linear_(toWorld),
      flipsBitangents_(glm::determinant(glm::dmat3(toWorld)) < 0),
      recomputed_(conventions.vertexNormals == VertexNormals::Recomputed),
      turnsToNormals_(conventions.winding == Winding::TowardsNormals),
      mirrored_(turnsToNormals_ && flipsBitangents_) {
    std::vector<glm::dvec3> exact;
    for (const glm::dvec3& p : mesh.positions)
        exact.push_back(glm::dvec3(toWorld * glm::dvec4(p, 1)));
    points_.assign(exact.begin(), exact.end());
    if (recomputed_) {
        normals_ = recomputedVertexNormals(exact, mesh.parts);
    } else {
        const glm::dmat3 transform = normalTransform(toWorld);
        for (const glm::dvec3& n : mesh.normals)
            normals_.push_back(transform * unit(n).value_or(glm::dvec3(0)));
    }
    for (glm::dvec3& n : normals_)
        n = unit(n).value_or(glm::dvec3(0));
    scenePosition_.assign(points_.size(), kUnused);
    sceneNormal_.assign(normals_.size(), kUnused);
    sceneAttributes_.assign(mesh.attributes.size(), kUnused);
}

void MeshPlacer::add(MeshTriangle corners, uint32_t material, uint32_t instance) {
    ++drops_.triangles;
    if (recomputed_)
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
    addAttributes(corners);
}

/// Turns the triangle to the side of its normals, if that is the convention. False if it needs
/// none: the file has none (a polygon without normals is plane, so it is shaded with its geometric
/// one), they are no use, or they are the geometric one.
bool MeshPlacer::chooseNormals(MeshTriangle& corners, const glm::dvec3 points[3], glm::dvec3 g,
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
    if (turnsToNormals_ && glm::dot(sum, g) < 0) {
        std::swap(corners[1], corners[2]);
        g = -g;
    }
    return recomputed_ || !isFlat(normals, g, points, twiceArea);
}

uint32_t MeshPlacer::positionIndex(uint32_t index) {
    uint32_t& place = scenePosition_[index];
    if (place == kUnused) {
        place = uint32_t(scene_.positions.size());
        scene_.positions.push_back(points_[index]);
    }
    return place;
}

uint32_t MeshPlacer::normalIndex(uint32_t index) {
    uint32_t& place = sceneNormal_[index];
    if (place == kUnused) {
        place = uint32_t(scene_.normals.size());
        scene_.normals.emplace_back(normals_[index]);
    }
    return place;
}

/// Scenes in which no triangle has attributes have no list of them.
void MeshPlacer::addAttributes(const MeshTriangle& corners) {
    constexpr std::array<uint32_t, 3> none = {kNoAttributes, kNoAttributes, kNoAttributes};
    const bool hasSome = corners[0].attributes != kNoAttributes;
    if (!hasSome && scene_.attributeCorners.empty()) return;
    scene_.attributeCorners.resize(scene_.triangles.size(), none);
    if (!hasSome) return;
    for (int i = 0; i < 3; ++i)
        scene_.attributeCorners.back()[i] = attributesIndex(corners[i].attributes);
}

uint32_t MeshPlacer::attributesIndex(uint32_t index) {
    uint32_t& place = sceneAttributes_[index];
    if (place != kUnused) return place;
    place = uint32_t(scene_.attributes.size());
    VertexAttributes attributes = mesh_.attributes[index];
    if (attributes.tangent.w != 0) {
        // Tangents lie in the surface and go with it; the bitangent is found by a cross product,
        // whose sense a mirror reverses.
        const std::optional<glm::dvec3> tangent =
            unit(linear_ * unit(glm::dvec3(attributes.tangent)).value_or(glm::dvec3(0)));
        const float sense = (attributes.tangent.w < 0) != flipsBitangents_ ? -1.0f : 1.0f;
        attributes.tangent = tangent ? glm::vec4(*tangent, sense) : glm::vec4(0);
        if (!tangent) ++drops_.badTangents;
    }
    scene_.attributes.push_back(attributes);
    return place;
}

} // namespace stromboli::build
