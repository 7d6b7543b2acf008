#include "scene/generate/forest.hpp"

#include "host/core/random.hpp"
#include "scene/model/default_light.hpp"
#include "scene/model/placements.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace stromboli {
namespace {

constexpr float kTurn = 6.28318531f;
constexpr uint32_t kSides = 6; ///< of branches

enum SurfaceOf : uint32_t { kBark, kLeaf, kGround };

/// One tree, about the y axis from the origin up: branches that fork, and leaves at their ends.
class Tree {
  public:
    Tree(Scene& scene, Random& random) : scene_(scene), random_(random) {}

    void grow() {
        const auto first = uint32_t(scene_.triangles.size());
        branch({0, 0, 0}, {0, 1, 0}, 1.5f, 0.12f, 5);
        const auto wood = uint32_t(scene_.triangles.size()) - first;
        for (uint32_t i = wood; i < kTreeTriangles; ++i)
            leaf(ends_[random_.below(uint32_t(ends_.size()))]);
        scene_.prototypes.push_back({first, kTreeTriangles});
    }

  private:
    void branch(const glm::vec3& from, const glm::vec3& along, float length, float radius,
                uint32_t forks) {
        const glm::vec3 to = from + length * along;
        tube(from, to, radius, 0.7f * radius);
        if (forks == 0) return ends_.push_back(to);
        for (uint32_t i = 0; i < 3; ++i) {
            const glm::vec3 next = glm::normalize(along + 0.9f * random_.direction());
            branch(to, next, length * random_.uniform(0.55f, 0.8f), 0.6f * radius, forks - 1);
        }
    }

    void tube(const glm::vec3& from, const glm::vec3& to, float radius, float endRadius) {
        const glm::vec3 axis = glm::normalize(to - from);
        const glm::vec3 other = std::abs(axis.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
        const glm::vec3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
        const auto position = uint32_t(scene_.positions.size());
        const auto normal = uint32_t(scene_.normals.size());
        for (uint32_t i = 0; i < kSides; ++i) {
            const float angle = kTurn * float(i) / float(kSides);
            const glm::vec3 n = std::cos(angle) * u + std::sin(angle) * v;
            scene_.positions.push_back(from + radius * n);
            scene_.positions.push_back(to + endRadius * n);
            scene_.normals.push_back(n);
        }
        for (uint32_t i = 0; i < kSides; ++i) {
            const uint32_t a = i, b = (i + 1) % kSides;
            addBark(position, normal, {2 * a, 2 * b, 2 * b + 1});
            addBark(position, normal, {2 * a, 2 * b + 1, 2 * a + 1});
        }
    }

    void addBark(uint32_t position, uint32_t normal, const std::array<uint32_t, 3>& corners) {
        Triangle t;
        t.material = kBark;
        for (size_t c = 0; c < 3; ++c) {
            t.corner[c] = position + corners[c];
            t.normals[c] = normal + corners[c] / 2;
        }
        scene_.triangles.push_back(t);
    }

    void leaf(const glm::vec3& end) {
        const glm::vec3 at = end + 0.25f * random_.direction() * random_.uniform();
        const glm::vec3 along = random_.direction(), aside = random_.direction();
        Triangle t;
        t.material = kLeaf;
        for (uint32_t& corner : t.corner)
            corner = uint32_t(scene_.positions.size()) + uint32_t(&corner - t.corner);
        scene_.triangles.push_back(t);
        scene_.positions.push_back(at);
        scene_.positions.push_back(at + 0.08f * along);
        scene_.positions.push_back(at + 0.06f * along + 0.05f * aside);
    }

    Scene& scene_;
    Random& random_;
    std::vector<glm::vec3> ends_;
};

Material colored(const char* name, const glm::vec3& albedo) {
    Material m;
    m.name = name;
    m.albedo = albedo;
    return m;
}

void addGround(Scene& scene, float half) {
    const auto first = uint32_t(scene.positions.size());
    for (const auto& [x, z] : {std::pair{-half, -half}, {-half, half}, {half, half}, {half, -half}})
        scene.positions.emplace_back(x, 0, z);
    for (const uint32_t middle : {1u, 2u}) {
        Triangle t;
        t.corner[0] = first, t.corner[1] = first + middle, t.corner[2] = first + middle + 1;
        t.material = kGround;
        scene.triangles.push_back(t);
    }
}

void addCamera(Scene& scene, double half) {
    FileCamera camera;
    camera.name = "view";
    const double reach = std::min(half, 60.0);
    camera.position = {0, 0.25 * reach + 4, half + 0.3 * reach};
    camera.back = glm::normalize(glm::dvec3(0, 0.35, 1));
    camera.up = glm::cross(camera.back, camera.right);
    camera.halfWidth = 0.45;
    camera.pointAhead = camera.position - camera.back;
    scene.cameras.push_back(camera);
}

} // namespace

Scene forest(uint32_t trees, const std::string& source) {
    constexpr float kSpacing = 3; // metres
    Scene scene;
    scene.file = source;
    scene.materials = {colored("bark", {0.25f, 0.17f, 0.1f}), colored("leaf", {0.15f, 0.4f, 0.08f}),
                       colored("ground", {0.3f, 0.25f, 0.15f})};
    scene.instances = {"ground"};
    Random random(2026);
    for (int kind = 0; kind < 3; ++kind)
        Tree(scene, random).grow();
    const auto across = uint32_t(std::ceil(std::sqrt(double(trees))));
    const float half = 0.5f * kSpacing * float(across);
    addGround(scene, half + kSpacing);
    scene.placements.reserve(trees);
    scene.instances.reserve(trees + 1);
    for (uint32_t i = 0; i < trees; ++i) {
        const glm::vec3 at(kSpacing * (float(i % across) + random.uniform()) - half, 0,
                           kSpacing * (float(i / across) + random.uniform()) - half);
        glm::dmat4 m = glm::translate(glm::dmat4(1), glm::dvec3(at));
        m = glm::rotate(m, double(kTurn * random.uniform()), glm::dvec3(0, 1, 0));
        m = glm::rotate(m, double(random.uniform(-0.1f, 0.1f)), glm::dvec3(1, 0, 0));
        const double width = random.uniform(0.8f, 1.2f);
        Placement p =
            *placementOf(glm::scale(m, glm::dvec3(width, random.uniform(0.7f, 1.4f), width)));
        p.prototype = random.below(3);
        p.instance = uint32_t(scene.instances.size());
        scene.placements.push_back(p);
        scene.instances.push_back("tree " + std::to_string(i));
    }
    scene.lights.push_back(defaultLight());
    addCamera(scene, half);
    return scene;
}

} // namespace stromboli
