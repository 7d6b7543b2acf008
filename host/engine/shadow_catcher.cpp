#include "host/engine/shadow_catcher.hpp"

#include "host/core/error.hpp"
#include "scene/model/surface_lookup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace stromboli {
namespace {

/// What of a scene is the catcher: the last object of its name (--ground comes after all objects of
/// a file, one of which may be called like it), else all that has a material of that name.
struct Catcher {
    const Scene& scene;
    std::optional<uint32_t> instance, material;

    Catcher(const Scene& s, const std::string& name) : scene(s) {
        const auto object = std::find(s.instances.rbegin(), s.instances.rend(), name);
        if (object != s.instances.rend()) {
            instance = uint32_t(s.instances.rend() - object - 1);
            return;
        }
        const auto named = std::ranges::find(s.materials, name, &Material::name);
        if (named != s.materials.end()) material = uint32_t(named - s.materials.begin());
    }

    bool isThere() const { return instance || material; }
    template <class Primitive>
    bool has(const Primitive& p) const {
        return instance ? p.instance == *instance : p.material == material;
    }
};

/// The scene with the catcher's materials for itself, so that it can be hidden and shown alone.
/// isCatcher: whether a material is one of these.
struct Separated {
    Scene scene;
    std::vector<bool> isCatcher;

    Separated(const Scene& original, const std::string& name) : scene(original) {
        const Catcher catcher(original, name);
        isCatcher.assign(scene.materials.size(), false);
        if (catcher.material)
            isCatcher[*catcher.material] = true;
        else
            giveItsOwn(catcher);
    }

    /// An object may share its materials with others: it gets copies.
    void giveItsOwn(const Catcher& catcher) {
        std::vector<std::optional<uint32_t>> own(scene.materials.size());
        const auto takeOwn = [&](auto& primitive) {
            if (!catcher.has(primitive)) return;
            std::optional<uint32_t>& copy = own[primitive.material];
            if (!copy) {
                copy = uint32_t(scene.materials.size());
                const Material material = scene.materials[primitive.material];
                scene.materials.push_back(material);
            }
            primitive.material = *copy;
        };
        for (size_t i = scene.firstInWorld(); i < scene.triangles.size(); ++i)
            takeOwn(scene.triangles[i]);
        for (Sphere& sphere : scene.spheres)
            takeOwn(sphere);
        isCatcher.resize(scene.materials.size(), true);
    }

    /// From the camera alone: all else is as it was.
    void hideCatcher() {
        for (size_t i = 0; i < isCatcher.size(); ++i)
            if (isCatcher[i]) scene.materials[i].isHiddenFromCamera = true;
    }
    void hideAllElse() {
        for (size_t i = 0; i < isCatcher.size(); ++i)
            scene.materials[i].isHiddenFromCamera = !isCatcher[i];
    }
};

/// Leaves in the scene what `stays` holds for, a function of a triangle's or a sphere's material.
template <class Stays>
void keepOnly(Scene& scene, const Stays& stays) {
    std::vector<Triangle> triangles;
    std::vector<std::array<uint32_t, 3>> corners;
    for (size_t i = scene.firstInWorld(); i < scene.triangles.size(); ++i) {
        if (!stays(scene.triangles[i].material)) continue;
        triangles.push_back(scene.triangles[i]);
        if (!scene.attributeCorners.empty()) corners.push_back(scene.attributeCorners[i]);
    }
    std::erase_if(scene.spheres, [&](const Sphere& s) { return !stays(s.material); });
    scene.prototypes.clear();
    scene.placements.clear();
    scene.triangles = std::move(triangles);
    scene.attributeCorners = std::move(corners);
}

/// Lamps shine evenly; what has a picture of where it shines is an object that glows in places.
bool glows(const Material& material) {
    return material.emits() && textureIn(material, TextureSlot::Emission);
}

} // namespace

void requireCatcher(const Scene& scene, const std::string& name) {
    const auto refuse = [&](const std::string& why) { throw SceneError(scene.file + ": " + why); };
    const Catcher catcher(scene, name);
    if (!catcher.isThere())
        refuse(fmt::format("there is no object or material '{}' to catch shadows (info lists them)",
                           name));
    const auto isIt = [&](const auto& primitive) { return catcher.has(primitive); };
    if (std::any_of(scene.triangles.begin(), scene.triangles.begin() + scene.firstInWorld(),
                    isIt) ||
        std::ranges::any_of(scene.placements, [&](const Placement& p) {
            return catcher.instance && p.instance == *catcher.instance;
        }))
        refuse(fmt::format("'{}' is to catch shadows and is shown as an instance: use --instances "
                           "copies",
                           name));
    if (!scene.media.empty()) refuse("a shadow catcher cannot stand in fog or other media");
}

Scene withoutCatcher(const Scene& scene, const std::string& catcher) {
    Separated separated(scene, catcher);
    separated.hideCatcher();
    return std::move(separated.scene);
}

namespace {

void switchOffGlow(Scene& scene) {
    for (Material& material : scene.materials)
        if (glows(material)) material.emission = glm::vec3(0);
}

} // namespace

Scene catcherAmongObjects(const Scene& scene, const std::string& catcher) {
    Separated separated(scene, catcher);
    separated.hideAllElse();
    switchOffGlow(separated.scene);
    return std::move(separated.scene);
}

Scene catcherInGlow(const Scene& scene, const std::string& catcher) {
    Separated separated(scene, catcher);
    separated.hideAllElse();
    separated.scene.lights.clear();
    separated.scene.environment.reset();
    for (Material& material : separated.scene.materials)
        if (!glows(material)) material.emission = glm::vec3(0);
    return std::move(separated.scene);
}

bool objectsGlow(const Scene& scene) {
    return std::ranges::any_of(scene.materials, glows);
}

Scene catcherAlone(const Scene& scene, const std::string& catcher) {
    Separated separated(scene, catcher);
    Scene& alone = separated.scene;
    // Lights are chosen by the scene's size, and have to be chosen as among the objects.
    alone.framing = scene.framed();
    switchOffGlow(alone);
    keepOnly(alone, [&](uint32_t material) {
        return separated.isCatcher[material] || alone.materials[material].emits();
    });
    separated.hideAllElse();
    return std::move(alone);
}

CaughtLight caughtLight(const Film& amongObjects, const Film& alone, const Film& glow,
                        std::span<const float> coverage) {
    CaughtLight caught;
    for (size_t i = 0; i < coverage.size(); ++i) {
        const glm::dvec3 &h = amongObjects.pixels[i].mean, &g = alone.pixels[i].mean;
        double share = 1;
        for (int c = 0; c < 3; ++c)
            if (g[c] > 0) share = std::min(share, std::max(h[c], 0.0) / g[c]);
        caught.clear.push_back(float(1 - double(coverage[i]) * (1 - share)));
        glm::dvec3 added = h - share * g;
        if (!glow.pixels.empty()) added += glow.pixels[i].mean;
        caught.added.push_back(glm::vec3(added));
    }
    return caught;
}

void putUnder(Film& objects, std::span<const float> alpha, const CaughtLight& caught) {
    for (size_t i = 0; i < objects.pixels.size(); ++i)
        objects.pixels[i].mean += double(1 - alpha[i]) * glm::dvec3(caught.added[i]);
}

void addShadow(std::span<float> alpha, const CaughtLight& caught) {
    for (size_t i = 0; i < alpha.size(); ++i)
        alpha[i] = 1 - (1 - alpha[i]) * caught.clear[i];
}

} // namespace stromboli
