#include "host/api/scene_maker.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace stromboli::api {
namespace {

constexpr double kRadians = glm::pi<double>() / 180;

struct Slot {
    const char* name;
    TextureSlot slot;
};
constexpr Slot kSlots[] = {
    {"base_color", TextureSlot::BaseColor},
    {"roughness_metallic", TextureSlot::MetallicRoughness},
    {"normal", TextureSlot::Normal},
    {"emission", TextureSlot::Emission},
};

struct KindOfLight {
    const char* name;
    LightKind kind;
};
constexpr KindOfLight kLights[] = {
    {"directional", LightKind::Directional}, {"point", LightKind::Point}, {"spot", LightKind::Spot},
    {"ambient", LightKind::Ambient},         {"area", LightKind::Area},
};

void requireFinite(const std::string& what, std::span<const double> numbers) {
    if (!std::ranges::all_of(numbers, [](double x) { return std::isfinite(x); }))
        throw UsageError(fmt::format("{}: a number is not finite", what));
}
void requireFinite(const std::string& what, const glm::dvec3& v) {
    requireFinite(what, std::span(&v.x, 3));
}

LightKind kindOfLight(const std::string& name) {
    for (const KindOfLight& row : kLights)
        if (name == row.name) return row.kind;
    std::vector<const char*> names;
    for (const KindOfLight& row : kLights)
        names.push_back(row.name);
    throw UsageError(fmt::format("there is no light of the kind '{}': expected {}", name,
                                 fmt::join(names, ", ")));
}

/// A frame whose -z axis points in the direction; y is up as far as that is possible.
glm::dmat4 aimed(const glm::dvec3& position, const glm::dvec3& direction, const glm::dvec3& up) {
    const glm::dvec3 back = -glm::normalize(direction);
    glm::dvec3 right = glm::cross(up, back);
    if (glm::length(right) < 1e-9 * glm::length(up)) // up is along the axis
        right =
            glm::cross(std::abs(back.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1), back);
    right = glm::normalize(right);
    return {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
            glm::dvec4(position, 1)};
}

Light lightOf(const LightAsked& asked) {
    Light light;
    light.name = asked.name;
    light.kind = kindOfLight(asked.kind);
    light.color = glm::vec3(asked.color);
    if (light.kind == LightKind::Point || light.kind == LightKind::Spot) {
        light.constantAttenuation = 0; // `color` is an intensity
        light.quadraticAttenuation = 1;
    }
    light.falloffAngle = float(asked.angle * kRadians);
    if (asked.innerAngle) light.innerAngle = float(*asked.innerAngle * kRadians);
    return light;
}

glm::dmat4 placeOf(const LightAsked& light) {
    glm::dmat4 matrix = aimed(light.position, light.direction, {0, 1, 0});
    if (light.kind == "area") matrix = glm::scale(matrix, glm::dvec3(light.size, 1));
    return matrix;
}

FileCamera cameraOf(const CameraAsked& asked) {
    FileCamera camera;
    camera.name = asked.name;
    camera.halfHeight = std::tan(asked.fov * kRadians / 2);
    camera.lensRadius = asked.aperture / 2;
    camera.focusDistance = asked.focus;
    return camera;
}

} // namespace

uint32_t SceneMaker::addMaterial(Material material) {
    materials_.push_back(std::move(material));
    return uint32_t(materials_.size() - 1);
}

void SceneMaker::requireMaterial(uint32_t number) const {
    if (number >= materials_.size())
        throw UsageError(
            fmt::format("there is no material {}: there are {}", number, materials_.size()));
}

Material& SceneMaker::material(uint32_t number) {
    requireMaterial(number);
    return materials_[number];
}

std::pair<TextureImage, size_t> SceneMaker::textureOf(uint32_t width, uint32_t height, size_t count,
                                                      const char* what) const {
    const uint64_t texels = uint64_t(width) * height;
    if (width == 0 || height == 0 || width > 65536 || height > 65536 ||
        (count != 3 * texels && count != 4 * texels))
        throw UsageError(fmt::format("a texture of {} x {} texels has 3 or 4 {} for each, not {} "
                                     "{}",
                                     width, height, what, count, what));
    TextureImage image;
    image.name = fmt::format("texture {}", images_.size());
    image.width = width, image.height = height;
    return {std::move(image), count / texels};
}

uint32_t SceneMaker::addTexture(uint32_t width, uint32_t height, std::span<const uint8_t> bytes,
                                bool srgb) {
    auto [image, channels] = textureOf(width, height, bytes.size(), "bytes");
    image.words.resize(bytes.size() / channels);
    for (size_t i = 0; i < image.words.size(); ++i) {
        const uint8_t* texel = &bytes[i * channels];
        const uint32_t alpha = channels == 4 ? texel[3] : 255;
        image.words[i] =
            uint32_t(texel[0]) | uint32_t(texel[1]) << 8 | uint32_t(texel[2]) << 16 | alpha << 24;
    }
    images_.push_back(std::move(image));
    isSrgb_.push_back(srgb);
    return uint32_t(images_.size() - 1);
}

uint32_t SceneMaker::addTexture(uint32_t width, uint32_t height, std::span<const float> values) {
    constexpr float kLargestHalf = 65504;
    auto [image, channels] = textureOf(width, height, values.size(), "numbers");
    if (!std::ranges::all_of(values, [](float x) { return std::abs(x) <= kLargestHalf; }))
        throw UsageError("a texture's numbers are from -65504 to 65504");
    image.format = TexelFormat::RgbaHalf;
    for (size_t i = 0; i < values.size(); i += channels) {
        const float alpha = channels == 4 ? values[i + 3] : 1;
        image.words.push_back(glm::packHalf2x16({values[i], values[i + 1]}));
        image.words.push_back(glm::packHalf2x16({values[i + 2], alpha}));
    }
    images_.push_back(std::move(image));
    isSrgb_.push_back(false);
    return uint32_t(images_.size() - 1);
}

void SceneMaker::useTexture(uint32_t number, std::string_view slot, uint32_t texture) {
    Material& material = this->material(number);
    if (texture >= images_.size())
        throw UsageError(
            fmt::format("there is no texture {}: there are {}", texture, images_.size()));
    const auto* row =
        std::ranges::find(kSlots, slot, [](const Slot& s) { return std::string_view(s.name); });
    if (row == std::end(kSlots))
        throw UsageError(fmt::format("a texture cannot be the '{}' of a material: expected "
                                     "base_color, roughness_metallic, normal or emission",
                                     slot));
    if (row->slot == TextureSlot::BaseColor && !material.baseColor())
        throw UsageError("materials of this kind have no colour that a texture could be");
    std::erase_if(material.textures, [&](const TextureUse& use) { return use.slot == row->slot; });
    TextureUse use;
    use.slot = row->slot;
    use.texture = texture; // textures are added in the order of their images
    material.textures.push_back(use);
}

void SceneMaker::addMesh(const MeshArrays& arrays) {
    const size_t vertices = arrays.positions.size() / 3;
    if (arrays.positions.size() % 3 != 0 || arrays.triangles.size() % 3 != 0)
        throw UsageError("a mesh has three numbers for each vertex and three for each triangle");
    if (!arrays.normals.empty() && arrays.normals.size() != 3 * vertices)
        throw UsageError(
            fmt::format("a mesh of {} vertices has as many normals, or none", vertices));
    if (!arrays.uvs.empty() && arrays.uvs.size() != 2 * vertices)
        throw UsageError(fmt::format(
            "a mesh of {} vertices has as many texture coordinates, or none", vertices));
    for (const uint32_t vertex : arrays.triangles)
        if (vertex >= vertices)
            throw UsageError(fmt::format("a triangle names vertex {} of {}", vertex, vertices));
    requireMaterial(arrays.material);
    requireFinite("uvs", arrays.uvs);
    requireFinite("the matrix", std::span(&arrays.toWorld[0].x, 16));

    build::Mesh mesh;
    mesh.isFlat = arrays.normals.empty();
    for (size_t i = 0; i < vertices; ++i) {
        mesh.positions.emplace_back(arrays.positions[3 * i], arrays.positions[3 * i + 1],
                                    arrays.positions[3 * i + 2]);
        if (!arrays.normals.empty())
            mesh.normals.emplace_back(arrays.normals[3 * i], arrays.normals[3 * i + 1],
                                      arrays.normals[3 * i + 2]);
        if (arrays.uvs.empty()) continue;
        VertexAttributes attributes;
        attributes.uv[0] = attributes.uv[1] =
            glm::vec2(float(arrays.uvs[2 * i]), float(arrays.uvs[2 * i + 1]));
        mesh.attributes.push_back(attributes);
    }
    build::MeshPart part;
    const auto corner = [&](uint32_t vertex) {
        return build::Corner{vertex, arrays.normals.empty() ? kNoNormals : vertex,
                             arrays.uvs.empty() ? kNoAttributes : vertex};
    };
    for (size_t i = 0; i + 2 < arrays.triangles.size(); i += 3)
        part.push_back({corner(arrays.triangles[i]), corner(arrays.triangles[i + 1]),
                        corner(arrays.triangles[i + 2])});
    mesh.parts.push_back(std::move(part));
    shapes_.push_back({arrays.name, std::move(mesh), arrays.toWorld, arrays.material});
}

void SceneMaker::addSphere(const std::string& name, const glm::dvec3& center, double radius,
                           uint32_t material) {
    requireMaterial(material);
    requireFinite("the centre of a sphere", center);
    if (!(radius > 0) || !std::isfinite(radius))
        throw UsageError(fmt::format("a sphere's radius is greater than 0, not {:g}", radius));
    shapes_.push_back({name, radius, glm::translate(glm::dmat4(1), center), material});
}

void SceneMaker::addLight(const LightAsked& light) {
    const LightKind kind = kindOfLight(light.kind);
    for (const auto& [what, v] :
         {std::pair("position", light.position), std::pair("direction", light.direction),
          std::pair("color", light.color)})
        requireFinite(fmt::format("{} of a light", what), v);
    if (std::min({light.color.x, light.color.y, light.color.z}) < 0)
        throw UsageError("color of a light: expected numbers from 0 on");
    if (glm::length(light.direction) == 0)
        throw UsageError("direction of a light: expected a vector that is not 0");
    if (kind == LightKind::Spot && !(light.angle > 0 && light.angle <= 180))
        throw UsageError(fmt::format("angle of a spot: expected 0 to 180, not {:g}", light.angle));
    if (light.innerAngle && !(*light.innerAngle >= 0 && *light.innerAngle < light.angle))
        throw UsageError("inner_angle of a spot: expected less than its angle");
    if (kind == LightKind::Area && !(light.size.x > 0 && light.size.y > 0))
        throw UsageError("size of an area light: expected two lengths greater than 0");
    lights_.push_back(light);
}

void SceneMaker::addCamera(const CameraAsked& camera) {
    requireFinite("from", camera.from);
    requireFinite("at", camera.at);
    requireFinite("up", camera.up);
    if (camera.from == camera.at) throw UsageError("a camera looks at the point where it is");
    if (glm::length(camera.up) == 0)
        throw UsageError("up of a camera: expected a vector that is not 0");
    if (!(camera.fov > 0 && camera.fov < 179.999))
        throw UsageError(fmt::format("fov: expected 0 to 179.999 degrees, not {:g}", camera.fov));
    if (!(camera.aperture >= 0) || !(camera.focus > 0))
        throw UsageError("a camera's aperture is 0 or more, and its focus more than 0");
    cameras_.push_back(camera);
}

void SceneMaker::setEnvironment(uint32_t width, uint32_t height, std::span<const float> radiance,
                                double strength, double rotation) {
    if (width == 0 || height == 0 || radiance.size() != 3 * uint64_t(width) * height)
        throw UsageError(fmt::format("an environment of {} x {} has three numbers for each texel, "
                                     "not {} numbers",
                                     width, height, radiance.size()));
    if (!std::ranges::all_of(radiance, [](float x) { return x >= 0 && std::isfinite(x); }))
        throw UsageError("an environment's radiance is finite and not negative");
    if (!(strength >= 0) || !std::isfinite(strength) || !std::isfinite(rotation))
        throw UsageError("an environment's strength and rotation are finite, its strength not "
                         "negative");
    Environment environment;
    environment.name = "environment";
    environment.width = width, environment.height = height;
    environment.radiance.resize(radiance.size() / 3);
    for (size_t i = 0; i < environment.radiance.size(); ++i)
        environment.radiance[i] = {radiance[3 * i], radiance[3 * i + 1], radiance[3 * i + 2]};
    environment.strength = float(strength);
    environment.rotation = float(rotation * kRadians);
    environment_ = std::move(environment);
}

std::shared_ptr<Scene> SceneMaker::finish() {
    SceneMaker all = std::exchange(*this, SceneMaker(name_));
    build::SceneBuilder builder(all.name_, SceneConventions{});
    for (TextureImage& image : all.images_) {
        const size_t number = builder.addImage(std::move(image));
        Texture texture;
        texture.image = uint32_t(number);
        texture.srgb = all.isSrgb_[number];
        builder.addTexture(texture);
    }
    for (Material& material : all.materials_)
        builder.addMaterial(std::move(material));
    for (Shape& shape : all.shapes_) {
        const build::FilePlace where{all.name_, 0, shape.name};
        const build::ShapeId id =
            std::holds_alternative<double>(shape.form)
                ? builder.addSphere(shape.name, std::get<double>(shape.form))
                : builder.addMesh(shape.name, std::move(std::get<build::Mesh>(shape.form)));
        builder.place(where, id, shape.toWorld, std::span(&shape.material, 1), shape.name);
    }
    for (const LightAsked& light : all.lights_)
        builder.placeLight(lightOf(light), placeOf(light));
    for (const CameraAsked& camera : all.cameras_)
        builder.placeCamera(cameraOf(camera),
                            aimed(camera.from, camera.at - camera.from, camera.up));
    if (all.environment_) builder.setEnvironment(std::move(*all.environment_));
    return std::make_shared<Scene>(builder.finish());
}

} // namespace stromboli::api
