#include "scene/build/vertex_normals.hpp"

#include "scene/model/scene.hpp"

#include <algorithm>

namespace stromboli::build {
namespace {

/// A side of a triangle, in the direction of its winding.
struct DirectedEdge {
    uint32_t from, to;
    friend bool operator<(const DirectedEdge& a, const DirectedEdge& b) {
        return a.from != b.from ? a.from < b.from : a.to < b.to;
    }
    friend bool operator==(const DirectedEdge& a, const DirectedEdge& b) {
        return a.from == b.from && a.to == b.to;
    }
};

/// All sides of all triangles, sorted and without repetitions.
std::vector<DirectedEdge> collectEdges(std::span<const MeshPart> parts) {
    std::vector<DirectedEdge> edges;
    for (const MeshPart& part : parts)
        for (const MeshTriangle& t : part)
            for (int i = 0; i < 3; ++i)
                edges.push_back({t[i].position, t[(i + 1) % 3].position});
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

/// For each vertex on the boundary the next one along the boundary loop; kNoNormals for others.
std::vector<uint32_t> followBoundary(size_t vertexCount, const std::vector<DirectedEdge>& edges) {
    std::vector<uint32_t> next(vertexCount, kNoNormals);
    for (const DirectedEdge& edge : edges)
        if (!std::binary_search(edges.begin(), edges.end(), DirectedEdge{edge.to, edge.from}))
            next[edge.to] = edge.from;
    return next;
}

/// Sums over the neighbours of each vertex.
struct Neighbourhood {
    glm::dvec3 sum{0};
    double count = 0;
};

std::vector<Neighbourhood> sumNeighbours(std::span<const glm::dvec3> positions,
                                         const std::vector<DirectedEdge>& edges) {
    std::vector<Neighbourhood> around(positions.size());
    const auto add = [&](uint32_t vertex, uint32_t neighbour) {
        around[vertex].sum += positions[neighbour];
        around[vertex].count += 1;
    };
    for (const DirectedEdge& edge : edges) {
        add(edge.from, edge.to);
        // An inner edge comes by again in the other direction; an open one does not.
        if (!std::binary_search(edges.begin(), edges.end(), DirectedEdge{edge.to, edge.from}))
            add(edge.to, edge.from);
    }
    return around;
}

std::vector<glm::dvec3> sumFaces(std::span<const glm::dvec3> positions,
                                 std::span<const MeshPart> parts) {
    std::vector<glm::dvec3> sums(positions.size(), glm::dvec3(0));
    for (const MeshPart& part : parts)
        for (const MeshTriangle& t : part) {
            const glm::dvec3& a = positions[t[0].position];
            const glm::dvec3 cross =
                glm::cross(positions[t[1].position] - a, positions[t[2].position] - a);
            for (const Corner& corner : t)
                sums[corner.position] += cross;
        }
    return sums;
}

} // namespace

std::vector<glm::dvec3> recomputedVertexNormals(std::span<const glm::dvec3> positions,
                                                std::span<const MeshPart> parts) {
    const std::vector<DirectedEdge> edges = collectEdges(parts);
    const std::vector<uint32_t> next = followBoundary(positions.size(), edges);
    const std::vector<Neighbourhood> around = sumNeighbours(positions, edges);
    std::vector<glm::dvec3> normals = sumFaces(positions, parts);
    for (size_t v = 0; v < positions.size(); ++v) {
        if (next[v] == kNoNormals) continue;
        const Neighbourhood& ring = around[next[v]];
        const glm::dvec3 toNext = positions[next[v]] - positions[v];
        normals[v] = glm::cross(toNext, ring.sum - ring.count * positions[v]);
    }
    return normals;
}

} // namespace stromboli::build
