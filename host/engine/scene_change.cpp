#include "host/engine/scene_change.hpp"

#include "host/kernel/gpu_scene.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace stromboli {
namespace {

/// Coordinates of loaded scenes are within it (docs/theory/numerics.md).
constexpr double kFarthest = 0x1p60;

[[noreturn]] void refuse(const std::string& what) {
    throw std::invalid_argument(what);
}

glm::vec3 movedPoint(const glm::dmat4& motion, const glm::vec3& point) {
    return glm::dvec3(motion * glm::dvec4(glm::dvec3(point), 1));
}

bool isInRange(const glm::vec3& point) {
    return std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}) <= kFarthest;
}

/// By how much it stretches, if that is the same in all directions, up to the rounding of matrices
/// that are written with single precision; else 0.
double stretchOf(const glm::dmat4& motion) {
    const glm::dmat3 linear(motion);
    const glm::dmat3 squares = glm::transpose(linear) * linear;
    const double square = squares[0][0];
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            if (std::abs(squares[column][row] - (row == column ? square : 0)) > 1e-5 * square)
                return 0;
    return std::sqrt(square);
}

/// An affine matrix of finite numbers, with an inverse, that keeps right-handed frames so.
bool isMotion(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(m[column][row])) return false;
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) return false;
    return glm::determinant(glm::dmat3(m)) > 0;
}

glm::dmat4 matrixOf(const Placement& placement) {
    glm::dmat4 m(1);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            m[column][row] = placement.toWorld[size_t(row)][column];
    return m;
}

void requireMaterials(const Scene& scene, const std::map<uint32_t, Material>& materials) {
    for (const auto& [number, material] : materials) {
        const Material* before =
            number < scene.materials.size() ? &scene.materials[number] : nullptr;
        // Meshes that share their triangles do not emit.
        const bool mayBegin =
            scene.prototypes.empty() || !material.emits() || !before || before->emits();
        if (!before || !differInNumbers(*before, material) || !mayBegin)
            refuse(
                fmt::format("material {} differs in more than numbers, or is not there", number));
    }
}

bool mayBecome(const Light& before, const Light& after) {
    const auto textureOf = [](const Light& light) {
        return light.picture ? light.picture->texture : ~0u;
    };
    return before.kind == after.kind && textureOf(before) == textureOf(after) &&
           before.isFramed == after.isFramed &&
           before.upperHemisphereOnly == after.upperHemisphereOnly;
}

void requireLights(const Scene& scene, const std::map<uint32_t, Light>& lights) {
    for (const auto& [number, light] : lights)
        if (number >= scene.lights.size() || !mayBecome(scene.lights[number], light))
            refuse(fmt::format("light {} is of another kind, or is not there", number));
}

void requireEnvironment(const Scene& scene, const SceneChange& change) {
    if (!change.rotation && !change.environment) return;
    if (!scene.environment) refuse("the scene has no environment");
    if (change.rotation && !std::isfinite(*change.rotation))
        refuse("the rotation of the environment is not a finite number");
    if (change.environment && change.environment->isConstant() != scene.environment->isConstant())
        refuse("the environment is to be a picture where it is one, and else a constant");
}

} // namespace

ChangingScene::ChangingScene(std::shared_ptr<const Scene> original)
    : original_(std::move(original)), scene_(std::make_shared<Scene>(*original_)) {}

// --- What moves with an instance -----------------------------------------------------------------

ChangingScene::Parts ChangingScene::partsOf(uint32_t instance) const {
    Parts parts;
    for (uint32_t t = scene_->firstInWorld(); t < scene_->triangles.size(); ++t)
        if (scene_->triangles[t].instance == instance) parts.triangles.push_back(t);
    for (uint32_t s = 0; s < scene_->spheres.size(); ++s)
        if (scene_->spheres[s].instance == instance) parts.spheres.push_back(s);
    for (uint32_t p = 0; p < scene_->placements.size(); ++p)
        if (scene_->placements[p].instance == instance) parts.placements.push_back(p);
    return parts;
}

bool ChangingScene::boundsGrid(const Parts& parts) const {
    const auto isOfGrid = [&](uint32_t material) {
        const Material& m = scene_->materials[material];
        const auto varies = [&](uint32_t medium) {
            return medium != kNoMedium && scene_->media[medium].varies();
        };
        return m.boundsMedia && (varies(m.inside) || varies(m.outside));
    };
    return std::ranges::any_of(
               parts.triangles,
               [&](uint32_t t) { return isOfGrid(scene_->triangles[t].material); }) ||
           std::ranges::any_of(parts.spheres,
                               [&](uint32_t s) { return isOfGrid(scene_->spheres[s].material); });
}

namespace {

/// Numbers of something that triangles share, as Scene::positions, some of which are to belong to
/// one instance.
class OwnNumbers {
  public:
    explicit OwnNumbers(size_t count) : isOfOthers_(count), own_(count, kNone) {}

    void belongsToOthers(uint32_t number) { isOfOthers_[number] = true; }
    /// What the instance has in place of it; where others have it too, a copy is added to `values`.
    template <class T>
    uint32_t numberFor(uint32_t number, std::vector<T>& values) {
        uint32_t& own = own_[number];
        if (own != kNone) return own;
        own = number;
        if (isOfOthers_[number]) {
            own = uint32_t(values.size());
            values.push_back(T(values[number]));
        }
        return own;
    }
    /// Calls visit(own, original) for each.
    template <class Visit>
    void forEach(const Visit& visit) const {
        for (uint32_t i = 0; i < own_.size(); ++i)
            if (own_[i] != kNone) visit(own_[i], i);
    }

  private:
    static constexpr uint32_t kNone = ~0u;
    std::vector<bool> isOfOthers_;
    std::vector<uint32_t> own_;
};

} // namespace

/// Gives the instance positions, normals and tangents that no other one has.
void ChangingScene::makeOwn(Parts& parts) {
    Scene& s = *scene_;
    OwnNumbers positions(s.positions.size()), normals(s.normals.size()),
        attributes(s.attributes.size());
    const auto hasNormals = [&](uint32_t t) { return s.triangles[t].normals[0] != kNoNormals; };
    const auto hasAttributes = [&](uint32_t t) {
        return !s.attributeCorners.empty() && s.attributeCorners[t][0] != kNoAttributes;
    };
    size_t next = 0; // of parts.triangles, which are in ascending order
    for (uint32_t t = 0; t < s.triangles.size(); ++t) {
        if (next < parts.triangles.size() && parts.triangles[next] == t) {
            ++next;
            continue;
        }
        for (size_t c = 0; c < 3; ++c) {
            positions.belongsToOthers(s.triangles[t].corner[c]);
            if (hasNormals(t)) normals.belongsToOthers(s.triangles[t].normals[c]);
            if (hasAttributes(t)) attributes.belongsToOthers(s.attributeCorners[t][c]);
        }
    }
    for (const uint32_t t : parts.triangles)
        for (size_t c = 0; c < 3; ++c) {
            uint32_t& corner = s.triangles[t].corner[c];
            corner = positions.numberFor(corner, s.positions);
            if (hasNormals(t)) {
                uint32_t& normal = s.triangles[t].normals[c];
                normal = normals.numberFor(normal, s.normals);
            }
            if (hasAttributes(t)) {
                uint32_t& attribute = s.attributeCorners[t][c];
                if (s.attributes[attribute].tangent.w != 0)
                    attribute = attributes.numberFor(attribute, s.attributes);
            }
        }
    positions.forEach([&](uint32_t own, uint32_t o) { parts.positions.push_back({own, o}); });
    normals.forEach([&](uint32_t own, uint32_t o) { parts.normals.push_back({own, o}); });
    attributes.forEach([&](uint32_t own, uint32_t o) { parts.tangents.push_back({own, o}); });
}

// --- Changes -------------------------------------------------------------------------------------

void ChangingScene::require(const SceneChange& change) const {
    requireMaterials(*scene_, change.materials);
    requireLights(*scene_, change.lights);
    requireEnvironment(*scene_, change);
    for (const auto& [instance, motion] : change.motions) {
        if (instance >= original_->instances.size())
            refuse(fmt::format("there is no instance {}: there are {}", instance,
                               original_->instances.size()));
        const std::string& name = original_->instances[instance];
        if (!isMotion(motion))
            refuse(fmt::format("the motion of '{}' is to be an affine matrix of finite numbers "
                               "that has an inverse and does not mirror",
                               name));
        const Parts parts = partsOf(instance);
        if (boundsGrid(parts))
            refuse(fmt::format("'{}' is the border of a medium that differs from place to place, "
                               "which does not move",
                               name));
        if (parts.triangles.empty() && parts.spheres.empty() && parts.placements.empty())
            refuse(fmt::format("'{}' has no surfaces that could move", name));
        for (const uint32_t t : parts.triangles) {
            glm::dvec3 corners[3];
            for (size_t c = 0; c < 3; ++c) {
                const glm::vec3 p =
                    movedPoint(motion, original_->positions[original_->triangles[t].corner[c]]);
                if (!isInRange(p)) refuse(fmt::format("'{}' would go beyond 2^60 m", name));
                corners[c] = p;
            }
            if (glm::cross(corners[1] - corners[0], corners[2] - corners[0]) == glm::dvec3(0))
                refuse(fmt::format("the motion of '{}' leaves triangles without area", name));
        }
        for (const uint32_t s : parts.spheres) {
            const Sphere& sphere = original_->spheres[s];
            const double radius = stretchOf(motion) * double(sphere.radius);
            if (!(float(radius) > 0) || !(radius <= kFarthest) ||
                !isInRange(movedPoint(motion, sphere.center)))
                refuse(fmt::format("the motion of the sphere '{}' is to stretch all directions "
                                   "alike, and to leave it within 2^60 m",
                                   name));
        }
        for (const uint32_t p : parts.placements)
            if (!placementOf(motion * matrixOf(original_->placements[p])))
                refuse(fmt::format("the motion of '{}' stretches it too unequally", name));
    }
}

void ChangingScene::move(uint32_t instance, const glm::dmat4& motion) {
    const auto [place, isFirst] = moved_.try_emplace(instance);
    Parts& parts = place->second;
    if (isFirst) {
        parts = partsOf(instance);
        makeOwn(parts);
    }
    Scene& s = *scene_;
    const Scene& before = *original_;
    const glm::dmat3 linear(motion), ofNormals = glm::transpose(glm::inverse(linear));
    for (const Own& own : parts.positions)
        s.positions[own.number] = movedPoint(motion, before.positions[own.original]);
    // Where it was, everything is to the bit what it was: also what is made a unit vector again.
    const bool isBack = motion == glm::dmat4(1);
    for (const Own& own : parts.normals) {
        const glm::vec3& normal = before.normals[own.original];
        s.normals[own.number] =
            isBack ? normal : glm::vec3(glm::normalize(ofNormals * glm::dvec3(normal)));
    }
    for (const Own& own : parts.tangents) {
        const glm::vec4& tangent = before.attributes[own.original].tangent;
        const glm::vec3 turned = glm::normalize(linear * glm::dvec3(glm::vec3(tangent)));
        s.attributes[own.number].tangent = isBack ? tangent : glm::vec4(turned, tangent.w);
    }
    for (const uint32_t number : parts.spheres) {
        const Sphere& sphere = before.spheres[number];
        s.spheres[number].center = movedPoint(motion, sphere.center);
        s.spheres[number].radius = float(stretchOf(motion) * double(sphere.radius));
    }
    for (const uint32_t number : parts.placements) {
        const Placement& placement = before.placements[number];
        s.placements[number].toWorld = placementOf(motion * matrixOf(placement))->toWorld;
    }
    // What does not move keeps its tree (host/bvh/two_level_layout.hpp).
    s.movingInstances.resize(s.instances.size());
    s.movingInstances[instance] = true;
}

void ChangingScene::apply(const SceneChange& change) {
    require(change);
    for (const auto& [number, material] : change.materials)
        scene_->materials[number] = material;
    for (const auto& [number, light] : change.lights)
        scene_->lights[number] = light;
    if (change.environment) scene_->environment = *change.environment;
    if (change.rotation) scene_->environment->rotation = *change.rotation;
    for (const auto& [instance, motion] : change.motions)
        move(instance, motion);
}

} // namespace stromboli
