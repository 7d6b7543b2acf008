// MTL: what its statements become.

#include "scene/obj/material_rules.hpp"
#include "tests/scene/images/encoders.hpp"
#include "tests/scene/obj/obj_folder.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A folder with pictures of 2 x 1 pixels.
class ObjMaterials : public testing::Test {
  protected:
    ObjMaterials() {
        folder_.write("red green.png", png8(2, 1, 3, {255, 0, 0, 0, 255, 0}));
        folder_.write("mask.png", png8(2, 1, 1, {255, 51}));
        folder_.write("alpha.png", png8(2, 1, 4, {9, 9, 9, 255, 9, 9, 9, 102}));
    }
    Scene load(const std::string& statements, const SceneConventions& conventions = {}) const {
        folder_.write("m.mtl", "newmtl a\n" + statements);
        return folder_.load("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                            "usemtl a\nf 1/1 2/2 3/3\n",
                            conventions);
    }
    Material material(const std::string& statements) const {
        return load(statements).materials.at(0);
    }
    ObjFolder folder_;
};

const TextureUse* useOf(const Material& material, TextureSlot slot) {
    for (const TextureUse& use : material.textures)
        if (use.slot == slot) return &use;
    return nullptr;
}

const TextureImage& imageOf(const Scene& scene, TextureSlot slot) {
    return scene.images.at(scene.textures.at(useOf(scene.materials.at(0), slot)->texture).image);
}

TEST_F(ObjMaterials, DiffuseAndEmission) {
    const Material m = material("Kd 0.1 0.2 0.3\nKe 4 5 6\nKs 1 1 1\nNs 0\n");
    EXPECT_EQ(m.kind, MaterialKind::Diffuse);
    EXPECT_EQ(m.name, "a");
    EXPECT_EQ(m.albedo, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.emission, glm::vec3(4, 5, 6));
    EXPECT_EQ(m.alphaMode, AlphaMode::Opaque);
    EXPECT_EQ(material("Kd 0.25\n").albedo, glm::vec3(0.25f)); // one number is a grey
    EXPECT_EQ(material("").albedo, glm::vec3(0.5f));
    EXPECT_EQ(material("Ke 1 1 1\n").albedo, glm::vec3(0)); // a lamp
    EXPECT_EQ(material("illum 1\nKd 1 1 1\nKs 1 1 1\nNs 9\n").kind, MaterialKind::Diffuse);
}

/// alpha^2 = 2 / (Ns + 2): Ns = 30 has alpha 1/4 and roughness 1/2.
TEST_F(ObjMaterials, HighlightsAreRoughDielectrics) {
    EXPECT_DOUBLE_EQ(obj::roughnessOfExponent(30), 0.5);
    EXPECT_DOUBLE_EQ(obj::roughnessOfExponent(0), 1);
    const Material m = material("Kd 0.5 0.5 0.5\nKs 0.04 0.08 0.2\nNs 30\nillum 2\n");
    EXPECT_EQ(m.kind, MaterialKind::Principled);
    EXPECT_FLOAT_EQ(m.principled.roughness, 0.5f);
    EXPECT_EQ(m.principled.metallic, 0);
    // Times 0.04, what ior 1.5 reflects, it is Ks.
    EXPECT_FLOAT_EQ(m.principled.specularColor.x, 1);
    EXPECT_FLOAT_EQ(m.principled.specularColor.y, 2);
    EXPECT_FLOAT_EQ(m.principled.specularColor.z, 5);
}

TEST_F(ObjMaterials, MirrorsAndGlass) {
    for (const char* illum : {"3", "5"}) {
        const Material mirror = material(fmt::format("Kd 0 0 0\nKs 1 1 1\nillum {}\n", illum));
        EXPECT_EQ(mirror.principled.roughness, 0);
        EXPECT_FLOAT_EQ(mirror.principled.specularColor.x, 25);
    }
    for (const char* illum : {"4", "6", "7"}) {
        const Material glass = material(fmt::format("Ni 1.33\nTf 1 0.5 1\nillum {}\n", illum));
        EXPECT_EQ(glass.principled.transmission, 1);
        EXPECT_FALSE(glass.principled.isThin);
        EXPECT_FLOAT_EQ(glass.principled.ior, 1.33f);
        EXPECT_EQ(glass.principled.baseColor, glm::vec3(1, 0.5, 1));
        // Exporters write this for what is no glass.
        EXPECT_EQ(material(fmt::format("Kd 1 1 1\nNi 1\nillum {}\n", illum)).kind,
                  MaterialKind::Diffuse);
    }
}

TEST_F(ObjMaterials, MetallicRoughness) {
    const Material m = material("Kd 1 0.5 0\nPr 0.3\nPm 0.7\nPs 0.2\nPc 0.4\nPcr 0.1\naniso 0.5\n"
                                "anisor 0.25\nNi 1.4\n");
    const PrincipledParameters& p = m.principled;
    EXPECT_EQ(p.baseColor, glm::vec3(1, 0.5, 0));
    EXPECT_FLOAT_EQ(p.roughness, 0.3f);
    EXPECT_FLOAT_EQ(p.metallic, 0.7f);
    EXPECT_EQ(p.sheenColor, glm::vec3(0.2f));
    EXPECT_FLOAT_EQ(p.clearcoat, 0.4f);
    EXPECT_FLOAT_EQ(p.clearcoatRoughness, 0.1f);
    EXPECT_FLOAT_EQ(p.anisotropy, 0.5f);
    EXPECT_NEAR(p.anisotropyRotation, 1.570796, 1e-6);
    EXPECT_FLOAT_EQ(p.ior, 1.4f);
    const Scene scene = load("aniso 0.5\n");
    EXPECT_NE(scene.attributes.at(0).tangent.w, 0); // which tangents are for
}

TEST_F(ObjMaterials, Opacity) {
    EXPECT_EQ(material("d 0.25\n").alphaMode, AlphaMode::Blend);
    EXPECT_FLOAT_EQ(material("d 0.25\n").opacity, 0.25f);
    EXPECT_FLOAT_EQ(material("Tr 0.25\n").opacity, 0.75f);
    EXPECT_FLOAT_EQ(material("d 1\nTr 1\n").opacity, 1); // d counts
    EXPECT_THAT(load("d 0\n").report.warnings, Contains(HasSubstr("is not seen")));
    EXPECT_THAT(load("d 7\n").report.warnings, Contains(HasSubstr("clamped")));
}

TEST_F(ObjMaterials, PicturesMultiplyColours) {
    const Scene scene = load("Kd 0.5 0.5 0.5\nmap_Kd -s 2 3 1 -o 0.25 0.5 red green.png\n");
    const TextureUse* use = useOf(scene.materials[0], TextureSlot::BaseColor);
    ASSERT_TRUE(use);
    EXPECT_EQ(scene.materials[0].albedo, glm::vec3(0.5f));
    EXPECT_TRUE(scene.textures[use->texture].srgb);
    // The corner (1, 1) of the file, v upwards: at (2 + 0.25, 3 + 0.5), and v' = 1 - v.
    const glm::vec3 corner(1, 0, 1);
    EXPECT_FLOAT_EQ(glm::dot(use->uRow, corner), 2.25f);
    EXPECT_FLOAT_EQ(glm::dot(use->vRow, corner), 1 - 3.5f);
    EXPECT_EQ(imageOf(scene, TextureSlot::BaseColor).words[0] & 0xFFFFFF, 0x0000FFu);
    // Black hides a picture, which nobody means.
    EXPECT_EQ(material("Kd 0 0 0\nmap_Kd mask.png\n").albedo, glm::vec3(1));
    EXPECT_EQ(material("Ke 0 0 0\nmap_Ke mask.png\n").emission, glm::vec3(1));
    EXPECT_EQ(scene.textures[use->texture].wrapU, Wrap::Repeat);
    EXPECT_EQ(load("map_Kd -clamp on mask.png\n").textures[0].wrapU, Wrap::Clamp);
    SceneConventions plain;
    plain.textures = false;
    EXPECT_TRUE(load("map_Kd mask.png\n", plain).textures.empty());
}

TEST_F(ObjMaterials, OptionsBehindNamesQuotesAndCapitalsAreForgiven) {
    for (const char* map : {"mask.png -clamp on", "\"mask.png\"", "MASK.PNG", "x\\mask.png"}) {
        const std::string statement = std::string("map_Kd ") + map + "\n";
        const Scene scene = load(statement);
        EXPECT_EQ(scene.textures.size(), 1u) << map;
        EXPECT_EQ(scene.report.forgiven.size(), 1u) << map;
        SceneConventions strict;
        strict.strict = true;
        EXPECT_THROW(load(statement, strict), SceneError) << map;
    }
    EXPECT_EQ(load("map_Kd mask.png -clamp on\n").textures.at(0).wrapU, Wrap::Clamp);
}

TEST_F(ObjMaterials, PicturesLieBesideTheFileThatStatesTheMaterial) {
    std::filesystem::create_directories(folder_.path() / "lib");
    folder_.write("lib/m.mtl", "newmtl a\nmap_Kd own.png\n");
    folder_.write("lib/own.png", png8(1, 1, 1, {255}));
    const Scene scene = folder_.load("mtllib lib/m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl a\n"
                                     "vt 0 0\nf 1/1 2/1 3/1\n");
    EXPECT_EQ(scene.textures.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
}

TEST_F(ObjMaterials, PicturesOfOpacityBecomeAlpha) {
    const Scene grey = load("map_Kd red green.png\nmap_d mask.png\n");
    EXPECT_EQ(grey.materials[0].alphaMode, AlphaMode::Blend);
    EXPECT_EQ(imageOf(grey, TextureSlot::BaseColor).words[0], 0xFF0000FFu);
    EXPECT_EQ(imageOf(grey, TextureSlot::BaseColor).words[1], 0x3300FF00u);
    // A picture with alpha means its alpha; -imfchan says otherwise.
    EXPECT_EQ(imageOf(load("map_d alpha.png\n"), TextureSlot::BaseColor).words[1], 0x66FFFFFFu);
    EXPECT_EQ(imageOf(load("map_d -imfchan r alpha.png\n"), TextureSlot::BaseColor).words[1],
              0x09FFFFFFu);
    // Without map_d, alpha of map_Kd means nothing.
    EXPECT_EQ(imageOf(load("d 0.5\nmap_Kd alpha.png\n"), TextureSlot::BaseColor).words[1],
              0xFF090909u);
}

TEST_F(ObjMaterials, PicturesOfRoughnessAndMetalShareOne) {
    const Scene scene = load("map_Pr mask.png\nmap_Pm red green.png\n");
    EXPECT_EQ(scene.materials[0].principled.roughness, 1);
    EXPECT_EQ(scene.materials[0].principled.metallic, 1);
    // Luminances of red and green: 0.2126 and 0.7152.
    EXPECT_EQ(imageOf(scene, TextureSlot::MetallicRoughness).words[0], 0xFF36FFFFu);
    EXPECT_EQ(imageOf(scene, TextureSlot::MetallicRoughness).words[1], 0xFFB633FFu);
}

TEST_F(ObjMaterials, NormalMapsHaveTangents) {
    const Scene scene = load("norm -bm 0.5 mask.png\nbump mask.png\n");
    const TextureUse* use = useOf(scene.materials[0], TextureSlot::Normal);
    ASSERT_TRUE(use);
    EXPECT_EQ(use->scale, 0.5f);
    EXPECT_FALSE(scene.textures[use->texture].srgb);
    EXPECT_NEAR(scene.attributes.at(0).tangent.x, 1, 1e-6); // u grows along x
    EXPECT_EQ(scene.attributes.at(0).tangent.w, 1);
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("1 'bump' of a material")));
}

/// A picture as blue as directions are.
TEST_F(ObjMaterials, NormalMapsMayBeCalledBumps) {
    folder_.write("blue.png", png8(2, 1, 3, {128, 128, 255, 140, 120, 250}));
    const Scene scene = load("map_Bump -bm 0.5 blue.png\n");
    const TextureUse* use = useOf(scene.materials[0], TextureSlot::Normal);
    ASSERT_TRUE(use);
    EXPECT_EQ(use->scale, 0.5f);
    EXPECT_THAT(scene.report.ignored, Not(Contains(HasSubstr("bump"))));
    EXPECT_FALSE(useOf(load("map_Bump mask.png\n").materials[0], TextureSlot::Normal));
}

/// Blender 4.5's words for a Principled BSDF of roughness 1/2, of a metal, and of pictures.
TEST_F(ObjMaterials, OfBlenderMeanItsSurfaces) {
    const auto made = [&](const std::string& head, const std::string& statements) {
        folder_.write("m.mtl", head + "newmtl a\n" + statements);
        return folder_.load("mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                            "usemtl a\nf 1/1 2/2 3/3\n");
    };
    const std::string head = "# Blender 4.5.15 LTS MTL File: 'None'\n# www.blender.org\n\n";
    const Scene plain = made(
        head, "Ns 250\nKa 1 1 1\nKd 0.8 0.1 0.1\nKs 0.5 0.5 0.5\nKe 0 0 0\nNi 1.5\nd 1\nillum 2\n");
    const PrincipledParameters& p = plain.materials.at(0).principled;
    EXPECT_FLOAT_EQ(p.roughness, 0.5f);
    EXPECT_EQ(p.specularColor, glm::vec3(1)); // 4 %
    EXPECT_EQ(p.metallic, 0);
    EXPECT_EQ(p.baseColor, glm::vec3(0.8f, 0.1f, 0.1f));
    EXPECT_THAT(plain.report.ignored, IsEmpty());
    const std::string gold =
        "Ns 640\nKa 0.75 0.75 0.75\nKd 1 0.7 0.3\nKs 0.5 0.5 0.5\nNi 1.5\nillum 3\n";
    EXPECT_FLOAT_EQ(made(head, gold).materials.at(0).principled.metallic, 0.75f);
    EXPECT_NEAR(made(head, gold).materials.at(0).principled.roughness, 0.2, 1e-6);
    // Before 3.1 the version does not stand there, and smooth surfaces have 900.
    EXPECT_FLOAT_EQ(made("# Blender MTL File: 'a.blend'\n", "Ns 225\nKs 0.5 0.5 0.5\n")
                        .materials.at(0)
                        .principled.roughness,
                    0.5f);
    const PrincipledParameters glass =
        made(head, "Kd 1 0.5 1\nKs 0.5 0.5 0.5\nNi 1.45\nPr 0\nTf 1 1 1\n")
            .materials.at(0)
            .principled;
    EXPECT_EQ(glass.transmission, 1);
    EXPECT_FALSE(glass.isThin);
    EXPECT_FLOAT_EQ(glass.ior, 1.45f);
    EXPECT_EQ(made(head, "Ks 0.5 0.5 0.5\nPr 0.5\nPc 2\n").materials.at(0).principled.clearcoat,
              0.5f);
    // Others mean what they say.
    EXPECT_NE(made("# by hand\n", gold).materials.at(0).principled.metallic, 0.75f);
    const Scene pictures = made(
        head,
        "Ns 250\nKs 0.5 0.5 0.5\nmap_Ns mask.png\nmap_refl mask.png\nmap_Bump -bm 2 mask.png\n");
    const Material& m = pictures.materials.at(0);
    EXPECT_EQ(m.principled.roughness, 1);
    EXPECT_EQ(m.principled.metallic, 1);
    EXPECT_EQ(imageOf(pictures, TextureSlot::MetallicRoughness).words[1], 0xFF3333FFu);
    ASSERT_TRUE(useOf(m, TextureSlot::Normal));
    EXPECT_EQ(useOf(m, TextureSlot::Normal)->scale, 2);
}

/// A library that lies beside the file under its name stands for one that is not there, or not
/// named.
TEST_F(ObjMaterials, OfALibraryOfTheSameNameAreFound) {
    folder_.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    const std::string face = "v 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl red\nf 1 2 3\n";
    for (const char* library : {"mtllib none.mtl\n", ""}) {
        const Scene scene = folder_.load(library + face);
        EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(1, 0, 0));
        EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("'a.mtl' beside the file is read")));
    }
    // Where the named one has it, nobody looks for another.
    folder_.write("m.mtl", "newmtl red\nKd 0 1 0\n");
    EXPECT_EQ(folder_.load("mtllib m.mtl\n" + face).materials.at(0).albedo, glm::vec3(0, 1, 0));
}

/// A material that is not seen is one that nobody states.
TEST_F(ObjMaterials, TransparencyOfOneAloneIsAnOpacity) {
    EXPECT_EQ(material("Kd 1 1 1\nTr 1\n").alphaMode, AlphaMode::Opaque);
    EXPECT_FLOAT_EQ(material("Kd 1 1 1\nTr 0.75\n").opacity, 0.25f);
    EXPECT_EQ(material("Kd 1 1 1\nd 0\nTr 1\n").opacity, 0);
}

TEST_F(ObjMaterials, PicturesLieInTheFolder) {
    EXPECT_THAT(load("map_Kd .\\mask.png\n").report.forgiven, Contains(HasSubstr("backslashes")));
    EXPECT_THAT(load("map_Kd C:\\me\\mask.png\n").report.forgiven,
                Contains(HasSubstr("same name beside it")));
    for (const char* name :
         {"none.png", "../none.png", "/etc/passwd", "/dev/zero", "..", "m.mtl"}) {
        const Scene scene = load(fmt::format("Kd 0.3 0.3 0.3\nmap_Kd {}\n", name));
        EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("no picture on the surface")))
            << name;
        EXPECT_THAT(scene.textures, IsEmpty());
    }
    const ObjFolder outside;
    outside.write("secret.png", png8(1, 1, 1, {255}));
    std::filesystem::create_symlink(outside.path() / "secret.png", folder_.path() / "link.png");
    EXPECT_THAT(load("map_Kd link.png\n").textures, IsEmpty());
    EXPECT_THAT(
        load(fmt::format("map_Kd ../{}/secret.png\n", outside.path().filename().string())).textures,
        IsEmpty());
}

TEST_F(ObjMaterials, LibrariesAndNames) {
    folder_.write("my lib.mtl", "newmtl shiny  metal \nKd 1 0 0\nnewmtl shiny  metal\nKd 0 1 0\n");
    folder_.write("b.mtl", "newmtl b\nKd 0 0 1\n");
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    const Scene scene = folder_.load(mesh + "mtllib my lib.mtl\nmtllib none.mtl b.mtl\n"
                                            "usemtl shiny  metal\nf 1 2 3\nusemtl b\nf 1 2 3\n"
                                            "usemtl c\nf 1 2 3\n");
    ASSERT_EQ(scene.materials.size(), 3u);
    EXPECT_EQ(scene.materials[0].albedo, glm::vec3(1, 0, 0)); // the first one of two
    EXPECT_EQ(scene.materials[1].albedo, glm::vec3(0, 0, 1));
    EXPECT_EQ(scene.materials[2].albedo, glm::vec3(0.5f));
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("none.mtl b.mtl' is not in")));
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("there is no material 'c'")));
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("of this name is there already")));
}

/// `usemtl` and `newmtl` are written by different programs, or by hand.
TEST_F(ObjMaterials, NamesAreMeantWithoutQuotesCommentsAndCapitals) {
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 1 1 0\nmtllib m.mtl\n";
    folder_.write("m.mtl", "newmtl Wood\nKd 1 0 0\n");
    for (const char* name : {"wood", "\"Wood\"", "Wood # of oak"}) {
        const std::string text = mesh + "usemtl " + name + "\nf 1 2 3\n";
        const Scene scene = folder_.load(text);
        EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(1, 0, 0)) << name;
        EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("but 'Wood'"))) << name;
        SceneConventions strict;
        strict.strict = true;
        EXPECT_THROW(folder_.load(text, strict), SceneError) << name;
    }
    // A name that is there as it is written is never another one.
    folder_.write("m.mtl", "newmtl Wood\nKd 1 0 0\nnewmtl wood\nKd 0 1 0\n");
    EXPECT_EQ(folder_.load(mesh + "usemtl wood\nf 1 2 3\n").materials.at(0).albedo,
              glm::vec3(0, 1, 0));
}

TEST_F(ObjMaterials, LibrariesMayBeQuotedUrisOrWithoutTheirEnding) {
    folder_.write("m.mtl", "newmtl a\nKd 1 0 0\n");
    for (const char* name : {"\"m.mtl\"", "m", "file:m.mtl", "file:///home/me/m.mtl"}) {
        const Scene scene = folder_.load(std::string("v 0 0 0\nv 1 0 0\nv 1 1 0\nmtllib ") + name +
                                         "\nusemtl a\nf 1 2 3\n");
        EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(1, 0, 0)) << name;
        EXPECT_THAT(scene.report.forgiven, Not(IsEmpty())) << name;
    }
}

TEST_F(ObjMaterials, DecimalCommasAreReadAsPoints) {
    const Scene scene = load("Kd 0,25 0,5 0,75\nd 0,5\n");
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(scene.materials.at(0).opacity, 0.5f);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("decimal comma")));
}

TEST_F(ObjMaterials, MapsMayHavePlainNames) {
    const std::pair<const char*, const char*> names[] = {
        {"map_emissive", "map_Ke"},
        {"map_Opacity", "map_d"},
        {"map_Roughness", "map_Pr"},
        {"map_metallic", "map_Pm"},
        {"map_normal", "norm"},
        {"map_diffuse", "map_Kd"},
        {"Ks 1 1 1\nNs 9\nmap_specular", "Ks 1 1 1\nNs 9\nmap_Ks"}};
    for (const auto& [plain, known] : names) {
        const Scene scene = load(std::string(plain) + " mask.png\n");
        const Scene expected = load(std::string(known) + " mask.png\n");
        EXPECT_EQ(scene.textures.size(), 1u) << plain;
        EXPECT_EQ(scene.materials.at(0).textures.at(0).slot,
                  expected.materials.at(0).textures.at(0).slot)
            << plain;
        EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("it is read as"))) << plain;
    }
}

TEST_F(ObjMaterials, OfTwoMapsOfOneKindTheLastCounts) {
    const Scene scene = load("map_Kd mask.png\nmap_Kd red green.png\n");
    EXPECT_EQ(imageOf(scene, TextureSlot::BaseColor).words.at(0), 0xFF0000FFu);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("twice in a material")));
    EXPECT_THAT(load("bump mask.png\nmap_Bump mask.png\n").report.forgiven, IsEmpty());
}

TEST_F(ObjMaterials, PicturesMayHaveAColourSpaceOrAnotherEnding) {
    EXPECT_EQ(load("map_Kd -colorspace sRGB mask.png\n").textures.size(), 1u);
    EXPECT_THAT(load("map_Kd -colorspace linear mask.png\n").report.ignored,
                Contains(HasSubstr("-colorspace")));
    const Scene scene = load("map_Kd mask.tif\n");
    EXPECT_EQ(scene.textures.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("another ending")));
}

} // namespace
} // namespace stromboli::test
