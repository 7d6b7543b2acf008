#include "scene/build/scene_builder.hpp"

#include "host/core/error.hpp"
#include "scene/build/camera_pose.hpp"
#include "scene/build/clamp_reflectance.hpp"
#include "scene/build/light_pose.hpp"
#include "scene/build/vectors.hpp"
#include "scene/model/area_lights.hpp"
#include "scene/model/default_light.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace stromboli::build {

Material greyMaterial() {
    Material grey;
    grey.name = "default";
    grey.albedo = glm::vec3(0.5f);
    return grey;
}

SceneBuilder::SceneBuilder(std::string file, const SceneConventions& conventions)
    : conventions_(conventions), report_(conventions.strict) {
    scene_.file = std::move(file);
}

uint32_t SceneBuilder::addMaterial(Material material) {
    scene_.materials.push_back(std::move(material));
    return uint32_t(scene_.materials.size() - 1);
}

uint32_t SceneBuilder::addMedium(Medium medium) {
    medium.absorption = lightColor("absorption", medium.absorption);
    medium.scattering = lightColor("scattering", medium.scattering);
    medium.emission = lightColor("emission", medium.emission);
    const auto clampAsymmetry = [&](float& asymmetry) {
        const float inside = std::clamp(asymmetry, -kMostAsymmetry, kMostAsymmetry);
        if (inside != asymmetry)
            sayClamped(fmt::format("{}: the mean cosine of its phase function is clamped to {}",
                                   medium.name, inside));
        asymmetry = std::isnan(inside) ? 0 : inside;
    };
    clampAsymmetry(medium.asymmetry);
    for (PhaseLobe& lobe : medium.otherPhases)
        clampAsymmetry(lobe.asymmetry);
    scene_.media.push_back(std::move(medium));
    return uint32_t(scene_.media.size() - 1);
}

uint32_t SceneBuilder::addImage(TextureImage image) {
    scene_.images.push_back(std::move(image));
    return uint32_t(scene_.images.size() - 1);
}

const TextureImage& SceneBuilder::imageOf(uint32_t texture) const {
    return scene_.images.at(scene_.textures.at(texture).image);
}

uint32_t SceneBuilder::addTexture(const Texture& texture) {
    scene_.textures.push_back(texture);
    return uint32_t(scene_.textures.size() - 1);
}

uint32_t SceneBuilder::defaultMaterial() {
    if (!defaultMaterial_) defaultMaterial_ = addMaterial(greyMaterial());
    return *defaultMaterial_;
}

/// The picture is not what the numbers of the file would make of it, so that it is said in a
/// warning; with --strict it is an error.
void SceneBuilder::sayClamped(const std::string& line) {
    if (conventions_.strict)
        throw SceneError(scene_.file, 0, "", line + " (an error because of --strict)");
    report_.warn(line);
}

glm::vec3 SceneBuilder::reflectedFraction(std::string_view what, const glm::vec3& color) {
    if (!conventions_.clampReflectedFractions) return lightColor(what, color);
    glm::vec3 inside;
    for (int i = 0; i < 3; ++i)
        inside[i] = color[i] >= 0 ? std::min(color[i], 1.0f) : 0.0f; // NaN: 0
    if (inside != color)
        sayClamped(fmt::format("{}: a reflected fraction outside [0, 1] is clamped to it", what));
    return inside;
}

glm::vec3 SceneBuilder::lightColor(std::string_view what, const glm::vec3& color) {
    constexpr float most = std::numeric_limits<float>::max();
    glm::vec3 inside;
    bool isNumber = true;
    for (int i = 0; i < 3; ++i) {
        isNumber = isNumber && std::isfinite(color[i]);
        inside[i] = color[i] >= 0 ? std::min(color[i], most) : 0.0f;
    }
    if (!isNumber) {
        for (int i = 0; i < 3; ++i)
            if (!std::isfinite(color[i])) inside[i] = 0;
        sayClamped(
            fmt::format("{}: channels of a colour that are no finite numbers become 0", what));
    } else if (inside != color) {
        sayClamped(fmt::format("{}: negative channels of a colour become 0", what));
    }
    return inside;
}

/// The matrix for a world in which y is up, whatever is up in the file.
glm::dmat4 SceneBuilder::standing(const glm::dmat4& toWorld) const {
    constexpr glm::dmat4 kFromZUp({1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1});
    return conventions_.up == UpAxis::Z ? kFromZUp * toWorld : toWorld;
}

void SceneBuilder::placeLight(Light light, const glm::dmat4& stated) {
    const glm::dmat4 toWorld = standing(stated);
    if (light.kind == LightKind::Spot && !conventions_.spotLights)
        return report_.ignore("<spot> light", "gives no light in " + conventions_.renderer);
    if (light.kind == LightKind::Ambient)
        light.upperHemisphereOnly = conventions_.ambientFrom == AmbientFrom::UpperHemisphere;
    if (poseLight(light, toWorld, conventions_)) {
        scene_.lights.push_back(std::move(light));
        lightPlaces_.emplace_back(toWorld[3]);
    } else {
        report_.warn(fmt::format("light '{}' is left out: its node's transformation gives it no "
                                 "place, direction or area within 2^60",
                                 light.name));
    }
}

void SceneBuilder::addPortal(const glm::dvec3& corner, const glm::dvec3& edgeA,
                             const glm::dvec3& edgeB) {
    scene_.portals.push_back({glm::vec3(corner), glm::vec3(edgeA), glm::vec3(edgeB)});
    portalCorners_.push_back(corner);
}

void SceneBuilder::placeCamera(FileCamera camera, const glm::dmat4& stated, bool isMirrored) {
    const glm::dmat4 toWorld = standing(stated);
    const glm::dvec3 scale = axisLengths(toWorld);
    if (!poseCamera(camera, toWorld))
        return report_.warn(fmt::format(
            "camera '{}' is left out: its node's transformation is singular", camera.name));
    // A parallel projection has no length along the view.
    const bool isParallel = camera.projection == Projection::Orthographic;
    if (areUnequal(isParallel ? glm::dvec3(scale.x, scale.y, scale.y) : scale))
        report_.warn(fmt::format("camera '{}': its node scales the axes unequally, which its "
                                 "picture does not show",
                                 camera.name));
    if (isMirrored) camera.right = -camera.right;
    if (conventions_.scaleCameras) scaleCamera(camera, scale);
    scene_.cameras.push_back(std::move(camera));
}

void SceneBuilder::lightTheDark() {
    const bool hasGeometry = !scene_.triangles.empty() || !scene_.spheres.empty();
    if (!conventions_.defaultLight || !hasGeometry) return;
    if (picturesAreLamps_ ? shines(scene_) : lightsItsSurfaces(scene_)) return; // takes time
    // Before the light is there.
    const char* why = shines(scene_) ? "the pictures of emission are too weak to light the surfaces"
                                     : "the file has no light";
    scene_.lights.push_back(defaultLight());
    report_.assume(fmt::format("{}: a plain sky of radiance 1 lights the scene (--default-light "
                               "off: nothing does)",
                               why));
}

/// One function for the colours of all formats.
void SceneBuilder::clampReflectance() {
    if (!conventions_.clampReflectedFractions) return;
    size_t colors = 0;
    for (Shape& shape : shapes_)
        if (Mesh* mesh = std::get_if<Mesh>(&shape.form)) colors += clampColors(mesh->attributes);
    if (colors > 0)
        sayClamped(fmt::format("colours of vertices: {} reflected fractions outside [0, 1] are "
                               "clamped to it",
                               colors));
    if (const size_t texels = clampBaseColors(scene_))
        sayClamped(fmt::format("pictures: {} texels would reflect more than all light, or less "
                               "than none; they are clamped",
                               texels));
}

Scene SceneBuilder::finish() {
    clampReflectance();
    moveOrigin();
    placeMeshes();
    // What was left out may be all there was.
    const bool hasGeometry =
        !scene_.triangles.empty() || !scene_.spheres.empty() || !scene_.placements.empty();
    if (const std::string* first = report_.firstError(); first && !hasGeometry)
        throw SceneError(*first);
    for (const Shape& shape : shapes_)
        reportDrops(shape);
    lightTheDark();
    report_.writeTo(scene_.report);
    if (conventions_.areaLights == AreaLights::BecomeGeometry) resolveAreaLights(scene_);
    resolveMedia(scene_);
    return std::move(scene_);
}

} // namespace stromboli::build
