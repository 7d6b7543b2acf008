// Subdivision by C. Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987, with the rules of
// Hoppe et al., "Piecewise Smooth Surface Reconstruction", 1994, at the border.

#include "scene/pbrt/forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace stromboli::pbrt {
namespace {

using Face = std::array<uint32_t, 3>;

struct Control {
    std::vector<glm::dvec3> points;
    std::vector<Face> faces;
};

/// The vertices around one, in the order in which faces stand around it.
struct Ring {
    std::vector<uint32_t> vertices;
    bool isOpen = false; ///< it is on the border: the first and the last one are too
};

std::vector<Ring> ringsOf(const Control& control) {
    // Opposite to a vertex each of its faces has an edge.
    std::vector<std::vector<std::pair<uint32_t, uint32_t>>> edges(control.points.size());
    for (const Face& face : control.faces)
        for (size_t k = 0; k < 3; ++k)
            edges[face[k]].emplace_back(face[(k + 1) % 3], face[(k + 2) % 3]);
    std::vector<Ring> rings(control.points.size());
    for (size_t v = 0; v < rings.size(); ++v) {
        if (edges[v].empty()) continue;
        std::map<uint32_t, uint32_t> next;
        std::set<uint32_t> isEnd;
        for (const auto& [from, to] : edges[v]) {
            next[from] = to;
            isEnd.insert(to);
        }
        uint32_t start = edges[v].front().first;
        for (const auto& [from, to] : edges[v])
            if (!isEnd.contains(from)) {
                start = from;
                rings[v].isOpen = true;
                break;
            }
        uint32_t at = start;
        do {
            rings[v].vertices.push_back(at);
            const auto found = next.find(at);
            if (found == next.end()) {
                rings[v].isOpen = true;
                break;
            }
            at = found->second;
        } while (at != start && rings[v].vertices.size() <= edges[v].size());
    }
    return rings;
}

double loopBeta(size_t valence) {
    return valence == 3 ? 3.0 / 16 : 3.0 / (8 * double(valence));
}

glm::dvec3 weighed(const Control& control, const Ring& ring, uint32_t vertex, double beta,
                   double borderBeta) {
    const glm::dvec3& point = control.points[vertex];
    if (ring.vertices.empty()) return point;
    if (ring.isOpen)
        return (1 - 2 * borderBeta) * point + borderBeta * (control.points[ring.vertices.front()] +
                                                            control.points[ring.vertices.back()]);
    glm::dvec3 sum(0.0);
    for (const uint32_t other : ring.vertices)
        sum += control.points[other];
    return (1 - double(ring.vertices.size()) * beta) * point + beta * sum;
}

Control subdivided(const Control& control) {
    const std::vector<Ring> rings = ringsOf(control);
    Control finer;
    finer.points.reserve(control.points.size() * 4);
    for (uint32_t v = 0; v < control.points.size(); ++v)
        finer.points.push_back(
            weighed(control, rings[v], v, loopBeta(rings[v].vertices.size()), 1.0 / 8));
    // A point for each edge, by what is opposite to it.
    struct Middle {
        uint32_t number = 0;
        std::vector<uint32_t> opposite;
    };
    std::map<std::pair<uint32_t, uint32_t>, Middle> middles;
    const auto middleOf = [&](uint32_t a, uint32_t b, uint32_t opposite) {
        const auto [found, isNew] = middles.try_emplace(std::minmax(a, b));
        Middle& middle = found->second;
        if (isNew) {
            middle.number = uint32_t(finer.points.size());
            finer.points.push_back((control.points[a] + control.points[b]) / 2.0); // on the border
        }
        middle.opposite.push_back(opposite);
        return middle.number;
    };
    for (const Face& face : control.faces) {
        std::array<uint32_t, 3> m{};
        for (size_t k = 0; k < 3; ++k)
            m[k] = middleOf(face[k], face[(k + 1) % 3], face[(k + 2) % 3]);
        finer.faces.push_back({face[0], m[0], m[2]});
        finer.faces.push_back({face[1], m[1], m[0]});
        finer.faces.push_back({face[2], m[2], m[1]});
        finer.faces.push_back(m);
    }
    for (const auto& [edge, middle] : middles) {
        const std::vector<uint32_t>& across = middle.opposite;
        if (across.size() != 2) continue;
        finer.points[middle.number] =
            3.0 / 8 * (control.points[edge.first] + control.points[edge.second]) +
            1.0 / 8 * (control.points[across[0]] + control.points[across[1]]);
    }
    return finer;
}

/// The tangents of the limit surface have these weights inside; on the border the mean of the faces
/// is taken.
glm::dvec3 normalAt(const Control& control, const Ring& ring, uint32_t vertex) {
    glm::dvec3 first(0.0), second(0.0);
    const size_t count = ring.vertices.size();
    if (ring.isOpen) {
        glm::dvec3 sum(0.0);
        for (size_t i = 0; i + 1 < count; ++i)
            sum += glm::cross(control.points[ring.vertices[i]] - control.points[vertex],
                              control.points[ring.vertices[i + 1]] - control.points[vertex]);
        return sum;
    }
    for (size_t i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * double(i) / double(count);
        first += std::cos(angle) * control.points[ring.vertices[i]];
        second += std::sin(angle) * control.points[ring.vertices[i]];
    }
    return glm::cross(first, second);
}

} // namespace

Form subdividedForm(const Parameters& shape) {
    Control control;
    control.points = shape.points("P");
    build::Mesh checked;
    checked.positions = control.points;
    addTriangles(shape, shape.numbers("indices"), checked);
    for (const build::MeshTriangle& t : checked.parts.front())
        control.faces.push_back({t[0].position, t[1].position, t[2].position});
    const char* name = shape.has("levels") ? "levels" : "nlevels";
    int64_t levels = std::clamp<int64_t>(shape.integer(name).value_or(3), 0, 12);
    shape.skip({"scheme", "nlevels"});
    constexpr size_t kMostFaces = 2'000'000;
    for (size_t faces = control.faces.size(); levels > 0 && faces < kMostFaces; --levels) {
        control = subdivided(control);
        faces = control.faces.size() * 4;
    }
    if (levels > 0)
        shape.replaceParameter(name, build::Shortfall::Number,
                               "is so high that there would be too many triangles");
    const std::vector<Ring> rings = ringsOf(control);
    Form form;
    build::Mesh& mesh = form.mesh;
    for (uint32_t v = 0; v < control.points.size(); ++v) {
        const size_t valence = std::max<size_t>(rings[v].vertices.size(), 1);
        const double limit = 1 / (double(valence) + 3 / (8 * loopBeta(valence)));
        mesh.positions.push_back(weighed(control, rings[v], v, limit, 1.0 / 5));
        mesh.normals.push_back(rings[v].vertices.empty() ? glm::dvec3(0, 0, 1)
                                                         : normalAt(control, rings[v], v));
    }
    build::MeshPart& part = mesh.parts.emplace_back();
    for (const Face& face : control.faces)
        part.push_back({build::Corner{face[0], face[0], kNoAttributes},
                        build::Corner{face[1], face[1], kNoAttributes},
                        build::Corner{face[2], face[2], kNoAttributes}});
    return form;
}

} // namespace stromboli::pbrt
