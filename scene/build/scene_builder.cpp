#include "scene/build/scene_builder.hpp"

#include "scene/build/camera_pose.hpp"
#include "scene/build/light_pose.hpp"
#include "scene/build/vectors.hpp"
#include "scene/model/area_lights.hpp"
#include "scene/model/default_light.hpp"

#include <fmt/format.h>

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

glm::vec3 SceneBuilder::reflectedFraction(std::string_view what, const glm::vec3& color) {
    if (!conventions_.clampReflectedFractions) return lightColor(what, color);
    const glm::vec3 inside = glm::clamp(color, glm::vec3(0), glm::vec3(1));
    if (inside != color)
        report_.warn(fmt::format("{}: a reflected fraction outside [0, 1] is clamped to it", what));
    return inside;
}

glm::vec3 SceneBuilder::lightColor(std::string_view what, const glm::vec3& color) {
    const glm::vec3 inside =
        glm::clamp(color, glm::vec3(0), glm::vec3(std::numeric_limits<float>::max()));
    if (inside != color)
        report_.warn(fmt::format("{}: negative channels of a colour become 0", what));
    return inside;
}

void SceneBuilder::placeLight(Light light, const glm::dmat4& toWorld) {
    if (light.kind == LightKind::Spot && !conventions_.spotLights)
        return report_.ignore("<spot> light", "gives no light in " + conventions_.renderer);
    if (light.kind == LightKind::Ambient)
        light.upperHemisphereOnly = conventions_.ambientFrom == AmbientFrom::UpperHemisphere;
    if (poseLight(light, toWorld, conventions_)) {
        scene_.lights.push_back(std::move(light));
    } else {
        report_.warn(fmt::format("light '{}' is left out: its node's transformation gives it no "
                                 "place, direction or area within 2^60",
                                 light.name));
    }
}

void SceneBuilder::placeCamera(FileCamera camera, const glm::dmat4& toWorld, bool isMirrored) {
    const glm::dvec3 scale = axisLengths(toWorld);
    if (!poseCamera(camera, toWorld))
        return report_.warn(fmt::format(
            "camera '{}' is left out: its node's transformation is singular", camera.name));
    if (areUnequal(scale))
        report_.warn(fmt::format("camera '{}': its node scales the axes unequally, which its "
                                 "picture does not show",
                                 camera.name));
    if (isMirrored) camera.right = -camera.right;
    if (conventions_.scaleCameras) scaleCamera(camera, scale);
    scene_.cameras.push_back(std::move(camera));
}

void SceneBuilder::lightTheDark() {
    const bool hasGeometry = !scene_.triangles.empty() || !scene_.spheres.empty();
    if (!conventions_.defaultLight || !hasGeometry || shines(scene_)) return;
    scene_.lights.push_back(defaultLight());
    report_.assume(
        "the file has no light: a plain sky of radiance 1 lights the scene (--default-light "
        "off: nothing does)");
}

Scene SceneBuilder::finish() {
    placeMeshes();
    for (const Shape& shape : shapes_)
        reportDrops(shape);
    lightTheDark();
    report_.writeTo(scene_.report);
    if (conventions_.areaLights == AreaLights::BecomeGeometry) resolveAreaLights(scene_);
    return std::move(scene_);
}

} // namespace stromboli::build
