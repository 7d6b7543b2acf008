// Materials.

#include "scene/model/surface_lookup.hpp"
#include "tests/scene/gltf/material_text.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(GltfMaterials, Defaults) {
    const Material m = materialOf("");
    EXPECT_EQ(m.kind, MaterialKind::Principled);
    EXPECT_EQ(m.principled.baseColor, glm::vec3(1));
    EXPECT_EQ(m.principled.metallic, 1);
    EXPECT_EQ(m.principled.roughness, 1);
    EXPECT_EQ(m.principled.ior, 1.5f);
    EXPECT_EQ(m.alphaMode, AlphaMode::Opaque);
    EXPECT_TRUE(m.textures.empty());
    EXPECT_FALSE(m.emits());
}

TEST(GltfMaterials, MetallicRoughness) {
    const Material m = materialOf(R"("name": "gold", "pbrMetallicRoughness": {
        "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
        "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}})");
    EXPECT_EQ(m.name, "gold");
    EXPECT_EQ(m.principled.baseColor, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.opacity, 0.4f);
    EXPECT_EQ(m.principled.metallic, 0.5f);
    EXPECT_EQ(m.principled.roughness, 0.6f);
    EXPECT_NE(useOf(m, TextureSlot::BaseColor), nullptr);
    EXPECT_NE(useOf(m, TextureSlot::MetallicRoughness), nullptr);
}

TEST(GltfMaterials, Alpha) {
    const Material mask = materialOf(R"("alphaMode": "MASK", "alphaCutoff": 0.25)");
    EXPECT_EQ(mask.alphaMode, AlphaMode::Mask);
    EXPECT_EQ(mask.alphaCutoff, 0.25f);
    EXPECT_EQ(materialOf(R"("alphaMode": "BLEND")").alphaMode, AlphaMode::Blend);
}

TEST(GltfMaterials, Emission) {
    const Material m =
        materialOf(R"("emissiveFactor": [1, 0.5, 0], "emissiveTexture": {"index": 1},)" +
                   extension("KHR_materials_emissive_strength", R"("emissiveStrength": 6)"));
    EXPECT_EQ(m.emission, glm::vec3(6, 3, 0));
    EXPECT_NE(useOf(m, TextureSlot::Emission), nullptr);
    // A texture upon nothing shows nothing.
    EXPECT_TRUE(materialOf(R"("emissiveTexture": {"index": 1})").textures.empty());
}

TEST(GltfMaterials, TransmissionAndVolume) {
    const Material thin =
        materialOf(extension("KHR_materials_transmission",
                             R"("transmissionFactor": 0.7, "transmissionTexture": {"index": 1})"));
    EXPECT_EQ(thin.principled.transmission, 0.7f);
    EXPECT_TRUE(thin.principled.isThin);
    EXPECT_NE(useOf(thin, TextureSlot::Transmission), nullptr);
    const Material thick = materialOf(extension(
        "KHR_materials_volume",
        R"("thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.1, 0.2, 0.3])"));
    EXPECT_FALSE(thick.principled.isThin);
    EXPECT_EQ(thick.principled.attenuationDistance, 2);
    EXPECT_EQ(thick.principled.attenuationColor, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_TRUE(std::isinf(materialOf("").principled.attenuationDistance));
}

/// Grey that scatters as much as white marble: its single scattering keeps nearly all.
TEST(GltfMaterials, VolumesScatter) {
    const Scene scene = load(withMaterial(
        R"("extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 0.5,
                                     "attenuationColor": [0.1, 0.2, 0.3]},
            "KHR_materials_volume_scatter": {"multiscatterColor": [1, 0.5, 0],
                                             "scatterAnisotropy": 0.25}})"));
    const Material& m = scene.materials.at(0);
    ASSERT_TRUE(m.boundsMedia);
    const Medium& medium = scene.media.at(m.inside);
    EXPECT_EQ(medium.asymmetry, 0.25f);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(medium.extinction()[c], -std::log(0.1 * (c + 1)) / 0.5, 1e-5);
    EXPECT_NEAR(medium.scattering.x / medium.extinction().x, 1, 1e-3);
    EXPECT_GT(medium.scattering.y / medium.extinction().y, 0.8);
    EXPECT_NEAR(medium.scattering.z, 0, 1e-3);
}

TEST(GltfMaterials, SpecularAndIor) {
    EXPECT_EQ(materialOf(extension("KHR_materials_ior", R"("ior": 1.8)")).principled.ior, 1.8f);
    const Scene scene = load(withMaterial(extension("KHR_materials_ior", R"("ior": 0.5)")));
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("is 0.5, expected 0 or at least 1")));
    EXPECT_EQ(scene.materials.at(0).principled.ior, 1);
    // What specular and glossiness become: the specular colour is reflected at right angles.
    const PrincipledParameters endless =
        materialOf(extension("KHR_materials_ior", R"("ior": 0)")).principled;
    const double r = (double(endless.ior) - 1) / (double(endless.ior) + 1);
    EXPECT_NEAR(r * r, 1, 1e-3);
    const Material m = materialOf(extension(
        "KHR_materials_specular",
        R"("specularFactor": 0.5, "specularColorFactor": [2, 1, 0], "specularTexture": {"index": 0},
           "specularColorTexture": {"index": 0})"));
    EXPECT_EQ(m.principled.specular, 0.5f);
    EXPECT_EQ(m.principled.specularColor, glm::vec3(2, 1, 0));
    EXPECT_NE(useOf(m, TextureSlot::Specular), nullptr);
    EXPECT_NE(useOf(m, TextureSlot::SpecularColor), nullptr);
}

TEST(GltfMaterials, ClearcoatSheenAnisotropy) {
    const Material coat = materialOf(extension(
        "KHR_materials_clearcoat",
        R"("clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25, "clearcoatTexture": {"index": 0},
           "clearcoatRoughnessTexture": {"index": 0}, "clearcoatNormalTexture": {"index": 0, "scale": 2})"));
    EXPECT_EQ(coat.principled.clearcoat, 0.5f);
    EXPECT_EQ(coat.principled.clearcoatRoughness, 0.25f);
    ASSERT_NE(useOf(coat, TextureSlot::ClearcoatNormal), nullptr);
    EXPECT_EQ(useOf(coat, TextureSlot::ClearcoatNormal)->scale, 2);
    EXPECT_EQ(coat.textures.size(), 3u);
    const Material sheen = materialOf(extension(
        "KHR_materials_sheen",
        R"("sheenColorFactor": [0.5, 0, 1], "sheenRoughnessFactor": 0.75, "sheenColorTexture": {"index": 0},
           "sheenRoughnessTexture": {"index": 0})"));
    EXPECT_EQ(sheen.principled.sheenColor, glm::vec3(0.5f, 0, 1));
    EXPECT_EQ(sheen.principled.sheenRoughness, 0.75f);
    EXPECT_EQ(sheen.textures.size(), 2u);
    const Material brushed = materialOf(extension(
        "KHR_materials_anisotropy",
        R"("anisotropyStrength": 0.5, "anisotropyRotation": 1.5, "anisotropyTexture": {"index": 0})"));
    EXPECT_EQ(brushed.principled.anisotropy, 0.5f);
    EXPECT_EQ(brushed.principled.anisotropyRotation, 1.5f);
    EXPECT_NE(useOf(brushed, TextureSlot::Anisotropy), nullptr);
}

/// A material whose normal map and map of anisotropy have these transforms.
Scene brushedUnder(const std::string& normalTransform, const std::string& grainTransform) {
    const auto map = [](const std::string& transform) {
        return R"({"index": 0, )" + extension("KHR_texture_transform", transform) + "}";
    };
    return sceneOf(R"("normalTexture": )" + map(normalTransform) + ", " +
                   extension("KHR_materials_anisotropy",
                             R"("anisotropyStrength": 0.5, "anisotropyRotation": 1.5,
                                "anisotropyTexture": )" +
                                 map(grainTransform)));
}

TEST(GltfMaterials, GrainIsToldInTheFrameOfTheNormalMap) {
    const auto rotation = [](const std::string& normal, const std::string& grain) {
        return brushedUnder(normal, grain).materials.at(0).principled.anisotropyRotation;
    };
    // A map that is turned by an angle has its tangent that much clockwise of the mesh's.
    EXPECT_NEAR(rotation(R"("rotation": 0)", R"("rotation": 0.25)"), 1.25f, 1e-6f);
    EXPECT_NEAR(rotation(R"("rotation": 0.25)", R"("rotation": 0)"), 1.75f, 1e-6f);
    EXPECT_EQ(rotation(R"("rotation": 0.25)", R"("rotation": 0.25)"), 1.5f);
    // Where both are mirrored, one map still lies in the other as it does where neither is.
    const std::string mirrored = R"("scale": [-1, 1])";
    EXPECT_NEAR(rotation(mirrored, R"("scale": [-1, 1], "rotation": 0.25)"), 1.25f, 1e-6f);
    EXPECT_TRUE(brushedUnder(mirrored, mirrored).report.forgiven.empty());
    const Scene told = brushedUnder(mirrored, R"("scale": [1, 1])");
    EXPECT_THAT(told.report.forgiven,
                testing::Contains(testing::HasSubstr("maps of directions have coordinates")));
}

TEST(GltfMaterials, UnlitOnesEmit) {
    const Scene scene = sceneOf(R"("pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1],
        "baseColorTexture": {"index": 0}}, )" +
                                extension("KHR_materials_unlit", ""));
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.kind, MaterialKind::Diffuse);
    EXPECT_EQ(m.albedo, glm::vec3(0));
    EXPECT_EQ(m.emission, glm::vec3(0.1f, 0.2f, 0.3f));
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::Emission);
    EXPECT_THAT(scene.report.assumed, Contains(HasSubstr("unlit materials")));
}

TEST(GltfMaterials, WhatIsIgnoredIsReported) {
    const Scene scene = sceneOf(R"("occlusionTexture": {"index": 0}, )" +
                                extension("KHR_materials_dispersion", R"("dispersion": 0.5)"));
    EXPECT_THAT(scene.report.ignored,
                Contains("1 occlusion textures: what they foretell is computed"));
    EXPECT_THAT(scene.report.ignored,
                Contains(HasSubstr("KHR_materials_dispersion of a material without a volume")));
    EXPECT_EQ(scene.materials.at(0).principled.dispersion, 0);
}

TEST(GltfMaterials, Variants) {
    GltfText g = withMaterial(R"("name": "plain")");
    g.addTo("materials", R"("name": "other")");
    g.members["extensions"] =
        R"({"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}})";
    std::string& mesh = g.arrays["meshes"][0];
    mesh.insert(mesh.size() - 3, R"(, "extensions": {"KHR_materials_variants": {"mappings":
        [{"material": 1, "variants": [1]}]}})");
    const auto shown = [&](const std::string& variant) {
        SceneConventions conventions;
        conventions.selection.variant = variant;
        return load(g, conventions).materials.at(0).name;
    };
    EXPECT_EQ(shown(""), "plain");
    EXPECT_EQ(shown("day"), "plain");
    EXPECT_EQ(shown("night"), "other");
    SceneConventions conventions;
    conventions.selection.variant = "dusk";
    EXPECT_EQ(problem(g, conventions), "has no variant 'dusk'; there are day, night");
}

TEST(GltfMaterials, ColorsOfVerticesAreFractions) {
    const auto withColors = [](const std::string& material) {
        GltfText g = withMaterial(material);
        const size_t colors = g.addAccessor<float>({2, 0.5, -1, 1, 1, 1, 0, 0, 0}, "VEC3");
        std::string& mesh = g.arrays["meshes"][0];
        mesh.insert(mesh.find("\"POSITION\""), fmt::format(R"("COLOR_0": {}, )", colors));
        return load(g);
    };
    const Scene scene = withColors("");
    EXPECT_EQ(scene.attributes.at(scene.attributeCorners.at(0)[0]).color, glm::vec4(1, 0.5, 0, 1));
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("colours of vertices")));
}

/// A fraction of the largest number of the type is what is meant, and bytes of 0 or 1 may be it.
TEST(GltfMaterials, ColorsOfWholeNumbersAreFractionsWithoutSayingSo) {
    const auto withColors = [](const auto& numbers) {
        GltfText g = withMaterial("");
        const size_t colors = g.addAccessor(numbers, "VEC4");
        std::string& mesh = g.arrays["meshes"][0];
        mesh.insert(mesh.find("\"POSITION\""), fmt::format(R"("COLOR_0": {}, )", colors));
        return load(g);
    };
    const Scene bytes = withColors(std::vector<uint8_t>(12, 51));
    const Scene words = withColors(std::vector<uint16_t>(12, 13107));
    for (const Scene& scene : {bytes, words}) {
        const glm::vec4 color = scene.attributes.at(scene.attributeCorners.at(0)[0]).color;
        for (int i = 0; i < 4; ++i)
            EXPECT_FLOAT_EQ(color[i], 0.2f);
        EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("not 'normalized'")));
    }
    const Scene ones = withColors(std::vector<uint8_t>(12, 1));
    EXPECT_EQ(ones.attributes.at(0).color, glm::vec4(1));
    EXPECT_THAT(ones.report.forgiven, testing::IsEmpty());
}

/// A triangle whose unlit material has colours of corners, and emits 0.5, 0.25, 1 without them.
Scene unlitWithColors(const std::vector<float>& colors, const std::string& type,
                      const std::string& picture) {
    GltfText g = withMaterial(R"("pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1])" +
                              picture + "}, " + extension("KHR_materials_unlit", ""));
    const size_t accessor = g.addAccessor<float>(colors, type);
    std::string& mesh = g.arrays["meshes"][0];
    mesh.insert(mesh.find("\"POSITION\""), fmt::format(R"("COLOR_0": {}, )", accessor));
    return load(g);
}

TEST(GltfMaterials, UnlitOnesHaveColorsOfCorners) {
    // Within what half floats hold of the picture, 2^-11, and of its four texels together.
    constexpr double kHalf = 4 * 0x1p-11;
    for (const char* picture : {"", R"(, "baseColorTexture": {"index": 1})"}) {
        const Scene scene =
            unlitWithColors({1, 0.5, 0.25, 0, 2, 1, 0.75, 0.125, 0}, "VEC3", picture);
        const Material& m = scene.materials.at(scene.triangles.at(0).material);
        const glm::dvec3 at[] = {{1, 0.5, 0.25}, {0, 1, 1}, {0.75, 0.125, 0}}; // at most 1
        if (*picture) { // whose coordinates stay
            ASSERT_EQ(m.textures.size(), 2u);
            EXPECT_EQ(m.textures[0].uvSet, 0u);
            EXPECT_EQ(m.textures[1].uvSet, 1u);
            const uint32_t corner = scene.attributeCorners.at(0)[1];
            EXPECT_EQ(scene.attributes.at(corner).uv[0], glm::vec2(1, 1));
        }
        // Of the picture, which is linear in its 16 bits but for sRGB: one texel everywhere.
        const glm::dvec3 texel = *picture ? glm::dvec3(0, 0.2140411, 1) : glm::dvec3(1);
        for (const glm::dvec2& b : {glm::dvec2(0, 0), {1, 0}, {0, 1}, {0.25, 0.5}, {0.4, 0.1}}) {
            const glm::dvec3 emitted = emissionAt(scene, m, attributesAt(scene, 0, b.x, b.y));
            const glm::dvec3 color = (1 - b.x - b.y) * at[0] + b.x * at[1] + b.y * at[2];
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(emitted[c], color[c] * texel[c] * glm::dvec3(0.5, 0.25, 1)[c], kHalf);
        }
    }
}

TEST(GltfMaterials, UnlitOnesOfOneColorNeedNoPicture) {
    const Scene scene =
        unlitWithColors({0.5, 1, 0.25, 0.75, 0.5, 1, 0.25, 0.75, 0.5, 1, 0.25, 0.75}, "VEC4", "");
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(m.emission, glm::vec3(0.25f, 0.25f, 0.25f));
    EXPECT_TRUE(m.textures.empty());
    EXPECT_EQ(scene.attributes.at(scene.attributeCorners.at(0)[0]).color, glm::vec4(1, 1, 1, 0.75));
}

TEST(GltfMaterials, DiffuseTransmission) {
    const Material m = materialOf(extension(
        "KHR_materials_diffuse_transmission",
        R"("diffuseTransmissionFactor": 0.25, "diffuseTransmissionColorFactor": [1, 0.5, 0.25],
           "diffuseTransmissionTexture": {"index": 1},
           "diffuseTransmissionColorTexture": {"index": 0})"));
    EXPECT_EQ(m.principled.diffuseTransmission, 0.25f);
    EXPECT_EQ(m.principled.diffuseTransmissionColor, glm::vec3(1, 0.5, 0.25));
    EXPECT_NE(useOf(m, TextureSlot::DiffuseTransmission), nullptr);
    EXPECT_NE(useOf(m, TextureSlot::DiffuseTransmissionColor), nullptr);
    EXPECT_FALSE(m.entersVolume());
    const Material none = materialOf(extension("KHR_materials_diffuse_transmission", ""));
    EXPECT_EQ(none.principled.diffuseTransmission, 0);
    EXPECT_EQ(none.principled.diffuseTransmissionColor, glm::vec3(1));
    const Material thick = materialOf(
        R"("extensions": {"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1},
                          "KHR_materials_volume": {"thicknessFactor": 1}})");
    EXPECT_TRUE(thick.entersVolume());
}

TEST(GltfMaterials, Dispersion) {
    const Material m = materialOf(
        R"("extensions": {"KHR_materials_dispersion": {"dispersion": 0.4},
                          "KHR_materials_volume": {"thicknessFactor": 1}})");
    EXPECT_EQ(m.principled.dispersion, 0.4f);
    // The Abbe number 50: the indices of the lines F and C are 0.5 / 50 apart.
    EXPECT_FLOAT_EQ(m.principled.indexSpread(), 0.005f);
}

TEST(GltfMaterials, Iridescence) {
    const Material film = materialOf(
        extension("KHR_materials_iridescence", R"("iridescenceFactor": 0.5, "iridescenceIor": 1.4,
        "iridescenceThicknessMaximum": 500, "iridescenceTexture": {"index": 1})"));
    EXPECT_EQ(film.principled.iridescence, 0.5f);
    EXPECT_EQ(film.principled.filmIor, 1.4f);
    EXPECT_EQ(film.principled.filmThickness, 500); // without a picture it is the maximum
    EXPECT_EQ(film.principled.filmSpan, 0);
    EXPECT_NE(useOf(film, TextureSlot::Iridescence), nullptr);
    const Material painted = materialOf(
        extension("KHR_materials_iridescence",
                  R"("iridescenceFactor": 1, "iridescenceThicknessTexture": {"index": 1})"));
    EXPECT_EQ(painted.principled.filmIor, 1.3f);
    EXPECT_EQ(painted.principled.filmThickness, 100);
    EXPECT_EQ(painted.principled.filmSpan, 300);
    EXPECT_NE(useOf(painted, TextureSlot::FilmThickness), nullptr);
    const Material none =
        materialOf(extension("KHR_materials_iridescence", R"("iridescenceTexture": {"index": 1})"));
    EXPECT_EQ(none.principled.iridescence, 0);
    EXPECT_TRUE(none.textures.empty());
}

TEST(GltfMaterials, SpecularGlossinessWithPictures) {
    GltfText g = withMaterial(extension(
        "KHR_materials_pbrSpecularGlossiness",
        R"("specularFactor": [1, 0.5, 0.2], "glossinessFactor": 0.5, "diffuseTexture": {"index": 1},
           "specularGlossinessTexture": {"index": 2})"));
    const size_t view = g.addView(png8(2, 1, 4, {255, 10, 20, 255, 30, 40, 50, 102}));
    g.addTo("images", fmt::format(R"("bufferView": {}, "mimeType": "image/png")", view));
    g.addTo("textures", R"("source": 2)");
    const Scene scene = load(g);
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.principled.metallic, 0);
    EXPECT_EQ(m.principled.roughness, 1); // all of it is in the picture
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(m.principled.specularColor[i], glm::vec3(25, 12.5, 5)[i], 1e-5);
    ASSERT_NE(useOf(m, TextureSlot::BaseColor), nullptr);
    ASSERT_NE(useOf(m, TextureSlot::SpecularColor), nullptr);
    ASSERT_NE(useOf(m, TextureSlot::MetallicRoughness), nullptr);
    const Texture& colors = scene.textures.at(useOf(m, TextureSlot::SpecularColor)->texture);
    EXPECT_TRUE(colors.srgb);
    EXPECT_EQ(scene.images.at(colors.image).words.at(1) & 0xFFFFFF, 0x32281Eu);
    const Texture& rough = scene.textures.at(useOf(m, TextureSlot::MetallicRoughness)->texture);
    EXPECT_FALSE(rough.srgb);
    const std::vector<uint32_t>& texels = scene.images.at(rough.image).words;
    EXPECT_EQ(texels.at(0) >> 8 & 0xFF, 128u); // 1 - 0.5 x 1
    EXPECT_EQ(texels.at(1) >> 8 & 0xFF, 204u); // 1 - 0.5 x 0.4
    EXPECT_TRUE(scene.report.ignored.empty());
}

/// White specular colours are for a picture to multiply: without it nothing becomes a mirror.
TEST(GltfMaterials, SpecularGlossinessIsNoChrome) {
    GltfText g = withMaterial(extension("KHR_materials_pbrSpecularGlossiness",
                                        R"("specularGlossinessTexture": {"index": 2})"));
    g.addTo("images", R"("uri": "none.png")");
    g.addTo("textures", R"("source": 2)");
    const Scene scene = load(g);
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("none.png")));
    EXPECT_EQ(scene.materials.at(0).principled.specularColor, glm::vec3(1));
    EXPECT_EQ(scene.materials.at(0).principled.roughness, 1);
}

} // namespace
} // namespace stromboli::test
