// Textures, the coordinates that they are looked up by, and colours of corners.

#include "host/cs184/cs184.hpp"
#include "tests/scene/collada/document_text.hpp"

#include "tests/scene/images/encoders.hpp"

#include <utility>

namespace stromboli::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A document with a textured triangle of two sets of texture coordinates, and what can be varied.
struct TexturedText {
    std::string path = "a.png";
    std::string sampler = "<source>surface</source>";
    std::string inputs = "<input semantic=\"TEXCOORD\" source=\"#uv0\" offset=\"1\" set=\"0\"/>"
                         "<input semantic=\"TEXCOORD\" source=\"#uv1\" offset=\"1\" set=\"1\"/>";
    std::string bindings =
        "<bind_vertex_input semantic=\"UV\" input_semantic=\"TEXCOORD\" input_set=\"0\"/>";
    std::string model = "<diffuse><texture texture=\"sampler\" texcoord=\"UV\"/></diffuse>";
    std::string image = "<init_from>{}</init_from>";

    static std::string pairs(const std::string& id, const std::string& numbers) {
        return fmt::format("<source id=\"{0}\"><float_array id=\"{0}-a\" count=\"6\">{1}"
                           "</float_array><technique_common><accessor source=\"#{0}-a\" "
                           "count=\"3\" stride=\"2\"><param name=\"S\" type=\"float\"/>"
                           "<param name=\"T\" type=\"float\"/></accessor></technique_common>"
                           "</source>",
                           id, numbers);
    }

    std::string str() const {
        DocumentText text;
        text.libraries =
            "<library_images><image id=\"picture\">" + fmt::format(fmt::runtime(image), path) +
            "</image></library_images><library_effects><effect id=\"e\"><profile_COMMON>"
            "<newparam sid=\"surface\"><surface type=\"2D\"><init_from>picture</init_from>"
            "</surface></newparam><newparam sid=\"sampler\"><sampler2D>" +
            sampler + "</sampler2D></newparam><technique sid=\"common\"><phong>" + model +
            "</phong></technique></profile_COMMON></effect></library_effects>"
            "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material>"
            "</library_materials>" +
            meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                        fmt::format("<triangles material=\"M\" count=\"1\">{}{}"
                                    "<p>0 0 1 1 2 2</p></triangles>",
                                    kVertexInput, inputs),
                        pairs("uv0", "0 0 0.25 0 0 0.75") + pairs("uv1", "0.5 1 2 -1 3 0.5") +
                            floats("rgb", "1 0.5 0 -1 2 0 0.25 0.5 1", 9));
        text.nodes = "<node><instance_geometry url=\"#mesh\"><bind_material><technique_common>"
                     "<instance_material symbol=\"M\" target=\"#m\">" +
                     bindings +
                     "</instance_material></technique_common></bind_material></instance_geometry>"
                     "</node>";
        return text.str();
    }
};

class ColladaTextures : public testing::Test {
  protected:
    ColladaTextures() {
        fs::create_directories(folder_ / "in" / "textures");
        write("in/a.png", picture());
    }
    ~ColladaTextures() override { fs::remove_all(folder_); }

    static std::string picture() { return png8(2, 1, 3, {255, 0, 0, 0, 0, 255}); }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    Scene load(const TexturedText& text, const SceneConventions& conventions = {}) const {
        write("in/scene.dae", text.str());
        return loadCollada(folder_ / "in" / "scene.dae", conventions);
    }
    static glm::vec2 uvOf(const Scene& scene, int corner, int set = 0) {
        return scene.attributes.at(scene.attributeCorners.at(0)[size_t(corner)]).uv[set];
    }
    static glm::vec4 colorOf(const Scene& scene, int corner) {
        return scene.attributes.at(scene.attributeCorners.at(0)[size_t(corner)]).color;
    }

    fs::path folder_ = fs::path(testing::TempDir()) / fmt::format("stromboli_tex_{}", getpid());
};

TEST_F(ColladaTextures, OfTheDiffuseColour) {
    const Scene scene = load({});
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].width, 2u);
    EXPECT_EQ(scene.images[0].words, (std::vector<uint32_t>{0xFF0000FF, 0xFFFF0000}));
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_TRUE(scene.textures[0].srgb);
    EXPECT_FALSE(scene.textures[0].nearest);
    const Material& material = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(material.kind, MaterialKind::Diffuse);
    EXPECT_EQ(material.albedo, glm::vec3(1));
    ASSERT_EQ(material.textures.size(), 1u);
    EXPECT_EQ(material.textures[0].slot, TextureSlot::BaseColor);
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
    EXPECT_THAT(scene.report.ignored, ElementsAre(HasSubstr("no texture looks them up")));
}

TEST_F(ColladaTextures, CountTFromTheLowerEdge) {
    const Scene scene = load({});
    EXPECT_EQ(uvOf(scene, 0), glm::vec2(0, 1));
    EXPECT_EQ(uvOf(scene, 1), glm::vec2(0.25f, 1));
    EXPECT_EQ(uvOf(scene, 2), glm::vec2(0, 0.25f));
}

TEST_F(ColladaTextures, BindingsChooseTheSet) {
    TexturedText text;
    text.bindings =
        "<bind_vertex_input semantic=\"UV\" input_semantic=\"TEXCOORD\" input_set=\"1\"/>";
    EXPECT_EQ(uvOf(load(text), 1), glm::vec2(2, 2));
    text.bindings =
        "<bind_vertex_input semantic=\"UV\" input_semantic=\"TEXCOORD\" input_set=\"7\"/>";
    const Scene other = load(text);
    EXPECT_EQ(uvOf(other, 1), glm::vec2(0.25f, 1));
    EXPECT_THAT(other.report.forgiven, ElementsAre(HasSubstr("no TEXCOORD of the set 7")));
    text.bindings = "";
    const Scene unbound = load(text);
    EXPECT_EQ(uvOf(unbound, 1), glm::vec2(0.25f, 1));
    EXPECT_THAT(unbound.report.assumed, Contains(HasSubstr("no <bind_vertex_input>")));
    text.model = "<diffuse><texture texture=\"sampler\" texcoord=\"CHANNEL1\"/></diffuse>";
    EXPECT_EQ(uvOf(load(text), 1), glm::vec2(2, 2));
}

TEST_F(ColladaTextures, OfTwoSetsForOneMaterial) {
    TexturedText text;
    text.model = "<emission><texture texture=\"sampler\" texcoord=\"E\"/></emission>"
                 "<diffuse><texture texture=\"sampler\" texcoord=\"UV\"/></diffuse>";
    text.bindings += "<bind_vertex_input semantic=\"E\" input_semantic=\"TEXCOORD\" "
                     "input_set=\"1\"/>";
    const Scene scene = load(text);
    const Material& material = scene.materials.at(scene.triangles.at(0).material);
    ASSERT_EQ(material.textures.size(), 2u);
    EXPECT_EQ(material.emission, glm::vec3(1));
    for (const TextureUse& use : material.textures)
        EXPECT_EQ(uvOf(scene, 1, int(use.uvSet)),
                  use.slot == TextureSlot::Emission ? glm::vec2(2, 2) : glm::vec2(0.25f, 1));
    EXPECT_EQ(scene.textures.size(), 1u) << "a sampler is read once";
}

TEST_F(ColladaTextures, WrapAndFilter) {
    const auto texture = [&](const std::string& states) {
        TexturedText text;
        text.sampler += states;
        return load(text).textures.at(0);
    };
    EXPECT_EQ(texture("").wrapU, Wrap::Repeat);
    const Texture two = texture("<wrap_s>MIRROR</wrap_s><wrap_t>CLAMP</wrap_t>");
    EXPECT_EQ(two.wrapU, Wrap::Mirror);
    EXPECT_EQ(two.wrapV, Wrap::Clamp);
    EXPECT_TRUE(texture("<minfilter>NEAREST</minfilter>").nearest);
    EXPECT_TRUE(texture("<magfilter>NEAREST</magfilter>").nearest);
    EXPECT_FALSE(texture("<minfilter>LINEAR</minfilter>").nearest);
    TexturedText border;
    border.sampler += "<wrap_s>BORDER</wrap_s>";
    const Scene scene = load(border);
    EXPECT_EQ(scene.textures[0].wrapU, Wrap::Clamp);
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("1 <wrap_s> BORDER")));
}

TEST_F(ColladaTextures, OfCollada15) {
    TexturedText text;
    text.sampler = "<instance_image url=\"#picture\"/>";
    text.image = "<init_from><ref>{}</ref></init_from>";
    EXPECT_EQ(load(text).images.size(), 1u);
}

TEST_F(ColladaTextures, PathsOfOtherMachines) {
    write("in/textures/b c.png", picture());
    SceneConventions strict;
    strict.strict = true;
    for (const char* path : {"a.png", "./a.png", "textures/b%20c.png", "textures/../a.png"}) {
        TexturedText text;
        text.path = path;
        EXPECT_EQ(load(text, strict).images.size(), 1u) << path;
    }
    TexturedText absolute;
    absolute.path = "file://" + (fs::canonical(folder_) / "in" / "a.png").string();
    EXPECT_EQ(load(absolute, strict).images.size(), 1u);
    for (const char* path :
         {"C:\\Users\\me\\a.png", "file:///C:/work/a.png", "/home/me/a.png", "..\\x\\a.png",
          "file://a.png", "textures\\b%20c.png", "http://example.org/a.png"}) {
        TexturedText text;
        text.path = path;
        const Scene scene = load(text);
        EXPECT_EQ(scene.images.size(), 1u) << path;
        EXPECT_EQ(scene.report.forgiven.size(), 1u) << path;
        EXPECT_THROW(load(text, strict), SceneError) << path;
    }
}

TEST_F(ColladaTextures, OtherCapitalsAreForgiven) {
    TexturedText text;
    text.path = "A.PNG";
    const Scene scene = load(text);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("has other capitals")));
    SceneConventions strict;
    strict.strict = true;
    EXPECT_THROW(load(text, strict), SceneError);
}

TEST_F(ColladaTextures, NothingOutsideTheFolderIsRead) {
    write("secret.png", picture());
    fs::create_symlink(folder_ / "secret.png", folder_ / "in" / "link.png");
    const std::string all = fs::canonical(folder_).string();
    for (const std::string& path :
         {std::string("../secret.png"), all + "/secret.png", "file://" + all + "/secret.png",
          std::string("link.png"), std::string("%2e%2e/secret.png"), std::string("textures")}) {
        TexturedText text;
        text.path = path;
        EXPECT_THAT(load(text).images, IsEmpty()) << path;
    }
}

TEST_F(ColladaTextures, APartOfAPictureIsSaid) {
    // A TGA of two rows of one grey pixel, of which the second is not there.
    write("in/part.tga", std::string("\0\0\3\0\0\0\0\0\0\0\0\0\1\0\2\0\x08\x20\7", 19));
    TexturedText text;
    text.path = "part.tga";
    const Scene scene = load(text);
    EXPECT_EQ(scene.images.size(), 1u);
    EXPECT_THAT(scene.report.forgiven,
                ElementsAre(HasSubstr("part.tga: the file is truncated: what there is of it")));
}

TEST_F(ColladaTextures, MissingOrDamagedOnesAreGrey) {
    write("in/bad.png", "\x89PNG\r\n\x1a\n");
    SceneConventions strict;
    strict.strict = true;
    for (const char* path : {"gone.png", "bad.png", ""}) {
        TexturedText text;
        text.path = path;
        const Scene scene = load(text);
        EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0.5f));
        EXPECT_THAT(scene.materials.at(0).textures, IsEmpty());
        EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("mid grey"))) << path;
        EXPECT_THROW(load(text, strict), SceneError) << path;
    }
    TexturedText bare;
    bare.inputs = "<input semantic=\"X\" source=\"#uv0\" offset=\"1\"/>";
    const Scene scene = load(bare);
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0.5f));
    EXPECT_THAT(scene.report.warnings, ElementsAre(HasSubstr("without texture coordinates")));
}

TEST_F(ColladaTextures, ColoursOfCorners) {
    TexturedText text;
    text.inputs = "<input semantic=\"COLOR\" source=\"#rgb\" offset=\"1\"/>";
    text.model = "<diffuse><color>0.5 0.5 0.5 1</color></diffuse>";
    const Scene scene = load(text);
    EXPECT_EQ(colorOf(scene, 0), glm::vec4(1, 0.5f, 0, 1));
    EXPECT_EQ(colorOf(scene, 1), glm::vec4(0, 1, 0, 1)) << "clamped to [0, 1]";
    EXPECT_THAT(scene.report.assumed, Contains(HasSubstr("multiply the diffuse colour")));
}

TEST_F(ColladaTextures, TheCs184RendererIgnoresThem) {
    TexturedText text;
    text.inputs += "<input semantic=\"COLOR\" source=\"#rgb\" offset=\"1\"/>";
    const Scene scene = load(text, cs184Conventions());
    EXPECT_THAT(scene.attributes, IsEmpty());
    EXPECT_THAT(scene.images, IsEmpty());
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0.5f));
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("1 <texture> of <diffuse>")));
}

TEST(ColladaTextureFiles, OfAssimp) {
    const fs::path folder = "/usr/share/assimp/models/Collada";
    if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
    for (const char* name :
         {"duck.dae", "duck_triangulate.dae", "duck.zae", "duck_nomanifest.zae"}) {
        const Scene scene = loadCollada(folder / name);
        ASSERT_EQ(scene.images.size(), 1u) << name;
        EXPECT_EQ(scene.images[0].width, 512u) << name;
        EXPECT_EQ(scene.attributeCorners.size(), scene.triangles.size()) << name;
    }
    EXPECT_FALSE(loadCollada(folder / "kwxport_test_vcolors.dae").attributes.empty());
}

} // namespace
} // namespace stromboli::test
