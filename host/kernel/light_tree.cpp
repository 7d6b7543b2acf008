#include "host/kernel/light_tree.hpp"

#include "host/kernel/alias_table.hpp"
#include "host/kernel/gpu_scene.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace stromboli {
namespace {

/// Triangles of a leaf. Fewer make the tree deeper: a level is two nodes to fetch and to weigh.
constexpr size_t kLeafTriangles = 8;
static_assert(kLeafTriangles <= gpu::LIGHT_NODE_MOST_TRIANGLES);

using Triangles = std::span<LightTriangle>;

glm::dvec3 centroid(const LightTriangle& t) {
    return (t.corner[0] + t.corner[1] + t.corner[2]) / 3.0;
}

glm::dvec3 normal(const LightTriangle& t) {
    const glm::dvec3 n = glm::cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
    const double length = glm::length(n);
    return length > 0 ? n / length : glm::dvec3(0, 0, 1);
}

/// All normals lie within this cone, which is not the smallest.
struct NormalCone {
    glm::dvec3 axis{0, 0, 1};
    double cosine = -1; ///< of its half angle
};

NormalCone coneOf(Triangles triangles) {
    glm::dvec3 sum(0.0);
    for (const LightTriangle& t : triangles)
        sum += t.power * normal(t);
    const double length = glm::length(sum);
    NormalCone cone;
    if (!(length > 0)) return cone;
    cone.axis = sum / length;
    cone.cosine = 1;
    for (const LightTriangle& t : triangles)
        cone.cosine = std::min(cone.cosine, glm::dot(cone.axis, normal(t)));
    return cone;
}

struct Box {
    glm::dvec3 lo{1e300}, hi{-1e300};
};

Box boxOf(Triangles triangles) {
    Box box;
    for (const LightTriangle& t : triangles)
        for (const glm::dvec3& p : t.corner)
            box.lo = glm::min(box.lo, p), box.hi = glm::max(box.hi, p);
    return box;
}

double powerOfAll(Triangles triangles) {
    double sum = 0;
    for (const LightTriangle& t : triangles)
        sum += t.power;
    return sum;
}

/// What the surface area heuristic of Conty Estevez and Kulla (equation 1) makes of a half; their
/// measure of orientation with emission over a hemisphere, as a function of the cosine, is close
/// to 2 - cosine.
double cost(Triangles triangles) {
    const Box box = boxOf(triangles);
    const glm::dvec3 e = box.hi - box.lo;
    return powerOfAll(triangles) * (e.x * e.y + e.y * e.z + e.z * e.x) *
           (2 - coneOf(triangles).cosine);
}

void sortAlong(Triangles triangles, int axis) {
    std::nth_element(triangles.begin(), triangles.begin() + triangles.size() / 2, triangles.end(),
                     [axis](const LightTriangle& a, const LightTriangle& b) {
                         const double x = centroid(a)[axis], y = centroid(b)[axis];
                         return x != y ? x < y : a.id < b.id;
                     });
}

int bestAxis(Triangles triangles) {
    int best = 0;
    double least = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        sortAlong(triangles, axis);
        const size_t half = triangles.size() / 2;
        const double sum = cost(triangles.first(half)) + cost(triangles.subspan(half));
        if (sum < least) least = sum, best = axis;
    }
    return best;
}

/// Rounded outwards: the sphere by 2^-20 of its radius, for the rounding of distances to it in the
/// shader; the cone, about the axis as it is stored, by 2^-20 for that of cosines.
gpu::LightNode boundsOf(Triangles triangles) {
    gpu::LightNode node{};
    const Box box = boxOf(triangles);
    node.center = glm::vec3(0.5 * (box.lo + box.hi));
    double radius2 = 0;
    bool bothSides = false;
    for (const LightTriangle& t : triangles) {
        bothSides |= t.bothSides;
        for (const glm::dvec3& p : t.corner) {
            const glm::dvec3 d = p - glm::dvec3(node.center);
            radius2 = std::max(radius2, glm::dot(d, d));
        }
    }
    node.radius = float(std::sqrt(radius2) * (1 + 0x1p-20));
    node.axis = encodeNormal(coneOf(triangles).axis);
    const glm::dvec3 axis = decodeNormal(node.axis);
    double cosine = 1;
    for (const LightTriangle& t : triangles)
        cosine = std::min(cosine, glm::dot(axis, normal(t)));
    node.cosSpread = float(std::max(cosine - 0x1p-20, -1.0));
    node.power = float(powerOfAll(triangles));
    node.child = bothSides ? gpu::LIGHT_NODE_BOTH_SIDES : 0;
    return node;
}

void addEntries(std::span<const LightTriangle> triangles, const std::vector<double>& weights,
                std::vector<gpu::EmitterEntry>& entries) {
    for (size_t i = 0; const AliasColumn& column : buildAliasTable(weights))
        entries.push_back(
            {triangles[i++].id, triangles[column.alias].id, float(column.threshold), 0});
}

std::vector<double> powersOf(std::span<const LightTriangle> triangles) {
    std::vector<double> powers;
    for (const LightTriangle& t : triangles)
        powers.push_back(t.power);
    return powers;
}

/// Fills in node `index`, which exists.
void build(LightTree& tree, Triangles triangles, uint32_t index, uint32_t level) {
    gpu::LightNode node = boundsOf(triangles);
    tree.levels = std::max(tree.levels, level);
    if (triangles.size() <= kLeafTriangles) {
        node.child |= gpu::LIGHT_NODE_IS_LEAF |
                      uint32_t(triangles.size()) << gpu::LIGHT_NODE_COUNT_SHIFT |
                      uint32_t(tree.entries.size());
        addEntries(triangles, powersOf(triangles), tree.entries);
        tree.nodes[index] = node;
        return;
    }
    sortAlong(triangles, bestAxis(triangles));
    const auto children = uint32_t(tree.nodes.size());
    tree.nodes.resize(children + 2);
    node.child |= children;
    tree.nodes[index] = node;
    const size_t half = triangles.size() / 2;
    build(tree, triangles.first(half), children, level + 1);
    build(tree, triangles.subspan(half), children + 1, level + 1);
}

} // namespace

std::vector<LightTriangle> lightTriangles(const Scene& scene,
                                          const std::vector<Emitter>& emitters) {
    std::vector<LightTriangle> all;
    for (const Emitter& emitter : emitters)
        for (const uint32_t index : emitter.triangles) {
            LightTriangle t;
            for (int i = 0; i < 3; ++i)
                t.corner[i] = scene.positions[scene.triangles[index].corner[i]];
            t.power = trianglePower(scene, index);
            t.bothSides = scene.materials[emitter.material].emitsBothSides;
            t.id = index;
            if (t.power > 0) all.push_back(t);
        }
    return all;
}

LightTree buildLightTree(std::vector<LightTriangle> triangles) {
    LightTree tree;
    tree.nodes.resize(1);
    build(tree, triangles, 0, 0);
    return tree;
}

std::vector<gpu::EmitterEntry> lightTable(const std::vector<LightTriangle>& triangles,
                                          bool uniformly) {
    std::vector<gpu::EmitterEntry> entries;
    addEntries(triangles,
               uniformly ? std::vector<double>(triangles.size(), 1) : powersOf(triangles), entries);
    return entries;
}

} // namespace stromboli
