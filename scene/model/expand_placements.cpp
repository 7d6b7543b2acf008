#include "host/core/error.hpp"
#include "scene/model/placements.hpp"

#include <string>

namespace stromboli {
namespace {

constexpr uint64_t kMostTriangles = uint64_t(1) << 28;
constexpr uint32_t kNotCopied = 0xFFFFFFFFu;

/// Gives one placement after the other triangles of its own.
class Expansion {
  public:
    explicit Expansion(const Scene& scene) : scene_(scene) {
        out_.scene = scene;
        out_.scene.prototypes.clear();
        out_.scene.placements.clear();
        out_.scene.triangles.clear();
        out_.scene.attributeCorners.clear();
        newPosition_.assign(scene.positions.size(), kNotCopied);
        newNormal_.assign(scene.normals.size(), kNotCopied);
    }

    ExpandedScene run() {
        for (uint32_t t = scene_.firstInWorld(); t < scene_.triangles.size(); ++t)
            add(scene_.triangles[t], t, kInNoPlacement);
        for (uint32_t i = 0; i < scene_.placements.size(); ++i)
            expand(i);
        return std::move(out_);
    }

  private:
    void expand(uint32_t number) {
        const Placement& placement = scene_.placements[number];
        const Prototype& p = scene_.prototypes[placement.prototype];
        const PlacementMatrices matrices = matricesOf(placement);
        const glm::dmat3 normals = glm::transpose(matrices.inverseLinear);
        for (uint32_t t = p.firstTriangle; t < p.firstTriangle + p.triangles; ++t) {
            Triangle copy = scene_.triangles[t];
            copy.instance = placement.instance;
            for (uint32_t& corner : copy.corner)
                corner = copied(newPosition_, corner, out_.scene.positions,
                                [&] { return placed(placement, scene_.positions[corner]); });
            for (uint32_t& normal : copy.normals)
                if (normal != kNoNormals)
                    normal = copied(newNormal_, normal, out_.scene.normals, [&] {
                        return glm::vec3(
                            glm::normalize(normals * glm::dvec3(scene_.normals[normal])));
                    });
            add(copy, t, number);
            if (!scene_.attributeCorners.empty()) placeTangents(matrices);
            if (matrices.mirrors) turnOver();
        }
        // The next placement has copies of its own.
        for (const uint32_t i : touchedPositions_)
            newPosition_[i] = kNotCopied;
        for (const uint32_t i : touchedNormals_)
            newNormal_[i] = kNotCopied;
        touchedPositions_.clear();
        touchedNormals_.clear();
    }

    template <class Make>
    uint32_t copied(std::vector<uint32_t>& places, uint32_t index, std::vector<glm::vec3>& to,
                    Make&& make) {
        if (places[index] == kNotCopied) {
            places[index] = uint32_t(to.size());
            to.push_back(make());
            (&places == &newPosition_ ? touchedPositions_ : touchedNormals_).push_back(index);
        }
        return places[index];
    }

    void add(const Triangle& triangle, uint32_t original, uint32_t placement) {
        out_.scene.triangles.push_back(triangle);
        if (!scene_.attributeCorners.empty())
            out_.scene.attributeCorners.push_back(scene_.attributeCorners[original]);
        out_.triangleOf.push_back(original);
        out_.placementOf.push_back(placement);
    }

    /// Tangents lie in the surface and go with it; the bitangent is found by a cross product, whose
    /// sense a mirror reverses.
    void placeTangents(const PlacementMatrices& m) {
        for (uint32_t& corner : out_.scene.attributeCorners.back()) {
            if (corner == kNoAttributes || scene_.attributes[corner].tangent.w == 0) continue;
            VertexAttributes attributes = scene_.attributes[corner];
            const glm::dvec3 tangent = m.linear * glm::dvec3(attributes.tangent);
            const float sense = (attributes.tangent.w < 0) != m.mirrors ? -1.0f : 1.0f;
            const double length = glm::length(tangent);
            attributes.tangent = length > 0 ? glm::vec4(tangent / length, sense) : glm::vec4(0);
            corner = uint32_t(out_.scene.attributes.size());
            out_.scene.attributes.push_back(attributes);
        }
    }

    /// Turns the last triangle, so that its geometric normal stays on the side that it was on.
    void turnOver() {
        Triangle& t = out_.scene.triangles.back();
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.normals[1], t.normals[2]);
        if (scene_.attributeCorners.empty()) return;
        auto& corners = out_.scene.attributeCorners.back();
        std::swap(corners[1], corners[2]);
    }

    const Scene& scene_;
    ExpandedScene out_;
    std::vector<uint32_t> newPosition_, newNormal_;
    std::vector<uint32_t> touchedPositions_, touchedNormals_;
};

} // namespace

ExpandedScene expandPlacements(const Scene& scene) {
    if (scene.placedTriangles() > kMostTriangles)
        throw SceneError("as copies, the instances of " + scene.file + " have " +
                         std::to_string(scene.placedTriangles()) + " triangles, more than the " +
                         std::to_string(kMostTriangles) + " there is room for");
    return Expansion(scene).run();
}

} // namespace stromboli
