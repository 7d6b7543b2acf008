#include "tests/scene/pbrt/retold_scene.hpp"

#include "host/film/image_formats.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

using pbrt::Version;

std::string numbers(const glm::dvec3& v) {
    return fmt::format("{:.9g} {:.9g} {:.9g} ", v.x, v.y, v.z);
}

std::string view(const Scene& scene, Version version) {
    const FileCamera& c = scene.cameras.at(0);
    const RenderHints& hints = scene.hints;
    EXPECT_FALSE(hints.crop);
    // The world as the camera sees it: x to the right, y up, z ahead.
    const glm::dmat3 rows(c.right, c.up, -c.back);
    const glm::dvec3 moved = -glm::transpose(rows) * c.position;
    std::string text = "Transform [";
    for (const int column : {0, 1, 2})
        text += numbers({rows[0][column], rows[1][column], rows[2][column]}) + "0 ";
    text += numbers(moved) + "1]\n";
    const double shorter = std::min(*c.halfWidth, *c.halfHeight);
    text += fmt::format("Camera \"perspective\" \"float fov\" {:.12g}\n",
                        glm::degrees(2 * std::atan(shorter)));
    text += fmt::format("Film \"{}\" \"integer xresolution\" {} \"integer yresolution\" {}\n",
                        version == Version::V3 ? "image" : "rgb", *hints.width, *hints.height);
    text += fmt::format("PixelFilter \"box\"\nIntegrator \"path\" \"integer maxdepth\" {}\n",
                        *hints.maxBounces);
    return text;
}

std::string material(const Scene& scene, const Material& m, Version version) {
    EXPECT_EQ(m.kind, MaterialKind::Diffuse);
    std::string text = "AttributeBegin\n";
    const bool isV3 = version == Version::V3;
    const char* name = isV3 ? "Kd" : "reflectance";
    const char* kind = isV3 ? "matte" : "diffuse";
    if (m.emits())
        text += fmt::format("AreaLightSource \"diffuse\" \"rgb L\" [{}] \"bool twosided\" {}\n",
                            numbers(m.emission), m.emitsBothSides);
    if (m.textures.empty())
        return text +
               fmt::format("Material \"{}\" \"rgb {}\" [{}]\n", kind, name, numbers(m.albedo));
    EXPECT_EQ(m.textures.size(), 1u);
    const TextureUse& use = m.textures[0];
    EXPECT_EQ(use.uRow, glm::vec3(1, 0, 0));
    EXPECT_EQ(use.vRow, glm::vec3(0, 1, 0));
    const std::string& file = scene.images[scene.textures[use.texture].image].name;
    return text + fmt::format("Texture \"picture\" \"{}\" \"imagemap\" \"string filename\" "
                              "\"{}\"\nMaterial \"{}\" \"texture {}\" \"picture\"\n",
                              isV3 ? "color" : "spectrum", file, kind, name);
}

/// All triangles of a material with or without normals, with three corners each.
std::string triangles(const Scene& scene, uint32_t material, bool hasNormals) {
    std::string points, normals, uvs, indices;
    int corners = 0;
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        if (t.material != material || (t.normals[0] != kNoNormals) != hasNormals) continue;
        for (size_t k = 0; k < 3; ++k) {
            points += numbers(scene.positions[t.corner[k]]);
            if (hasNormals) normals += numbers(scene.normals[t.normals[k]]);
            if (!scene.attributes.empty() && scene.attributeCorners[i][k] != kNoAttributes) {
                const glm::vec2 uv = scene.attributes[scene.attributeCorners[i][k]].uv[0];
                uvs += fmt::format("{:.9g} {:.9g} ", uv.x, 1 - uv.y);
            }
            indices += fmt::format("{} ", corners++);
        }
    }
    if (corners == 0) return "";
    std::string text = "Shape \"trianglemesh\" \"point3 P\" [" + points + "]";
    if (!normals.empty()) text += " \"normal N\" [" + normals + "]";
    if (!uvs.empty()) text += " \"point2 uv\" [" + uvs + "]";
    return text + " \"integer indices\" [" + indices + "]\n";
}

std::string light(const Light& light) {
    if (light.kind == LightKind::Point) {
        EXPECT_EQ(light.quadraticAttenuation, 1);
        return fmt::format("LightSource \"point\" \"rgb I\" [{}] \"point3 from\" [{}]\n",
                           numbers(light.color), numbers(light.position));
    }
    EXPECT_EQ(light.kind, LightKind::Directional);
    return fmt::format("LightSource \"distant\" \"rgb L\" [{}] \"point3 from\" [0 0 0] \"point3 "
                       "to\" [{}]\n",
                       numbers(light.color), numbers(light.direction));
}

/// The same with several rows for one, whose middles are half a row away from the poles, as all
/// pictures of pbrt's are.
Environment withoutPoleRows(const Environment& e) {
    if (!e.rowsReachPoles) return e;
    constexpr uint32_t kRows = 8;
    Environment result = e;
    result.rowsReachPoles = false;
    result.height = kRows * (e.height - 1);
    result.radiance.clear();
    for (uint32_t row = 0; row < result.height; ++row)
        for (uint32_t column = 0; column < e.width; ++column) {
            const size_t above = size_t(row / kRows) * e.width + column;
            result.radiance.push_back(glm::mix(e.radiance[above], e.radiance[above + e.width],
                                               (float(row % kRows) + 0.5f) / float(kRows)));
        }
    return result;
}

/// As pbrt-v3 has it, the zenith along z: columns run the other way round, from x on.
std::string environment(const Environment& stated, Version version) {
    EXPECT_EQ(version, Version::V3);
    const Environment e = withoutPoleRows(stated);
    FloatImage image(e.width, e.height);
    for (const auto& [channel, c] : {std::pair("R", 0), std::pair("G", 1), std::pair("B", 2)})
        for (uint32_t row = 0; row < e.height; ++row)
            for (uint32_t column = 0; column < e.width; ++column) {
                double u = 0.75 - (column + 0.5) / e.width + double(e.rotation) / (2 * M_PI);
                u -= std::floor(u);
                const auto from = std::min(uint32_t(u * e.width), e.width - 1);
                image.channels[channel].push_back(e.strength *
                                                  e.radiance[size_t(row) * e.width + from][c]);
            }
    writeExr(writeFile("environment.exr", ""), image);
    return "AttributeBegin Rotate -90 1 0 0 LightSource \"infinite\" \"string mapname\" "
           "\"environment.exr\" AttributeEnd\n";
}

} // namespace

std::string retold(const Scene& scene, Version version) {
    std::string text = view(scene, version) + "WorldBegin\n";
    EXPECT_TRUE(scene.placements.empty());
    for (uint32_t i = 0; i < scene.materials.size(); ++i) {
        const std::string mesh = triangles(scene, i, true) + triangles(scene, i, false);
        if (!mesh.empty())
            text += material(scene, scene.materials[i], version) + mesh + "AttributeEnd\n";
    }
    for (const Sphere& sphere : scene.spheres)
        text += material(scene, scene.materials[sphere.material], version) +
                fmt::format("Translate {}Shape \"sphere\" \"float radius\" {:.9g}\nAttributeEnd\n",
                            numbers(sphere.center), sphere.radius);
    for (const Light& each : scene.lights)
        text += light(each);
    if (scene.environment) text += environment(*scene.environment, version);
    return text + (version == Version::V3 ? "WorldEnd\n" : "");
}

} // namespace stromboli::test
