// Damaged documents end in a scene or a SceneError: never in a crash, a hang or another exception.
// Fixed seeds; worth running with STROMBOLI_SANITIZE=address,undefined.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"
#include "scene/model/emitters.hpp"

#include <cmath>
#include <random>

namespace stromboli::test {
namespace {

/// A document with one of everything.
std::string everything() {
    DocumentText document;
    document.asset = "<unit meter=\"0.5\"/><up_axis>Z_UP</up_axis>";
    document.libraries =
        "<library_cameras><camera id=\"c\"><optics><technique_common><perspective><xfov>49.1</xfov>"
        "<aspect_ratio>1.33</aspect_ratio><znear>0.1</znear><zfar>100</zfar></perspective>"
        "</technique_common></optics></camera></library_cameras>\n"
        "<library_lights><light id=\"l\"><technique_common><spot><color>10 10 10</color>"
        "<quadratic_attenuation>0.5</quadratic_attenuation><falloff_angle>45</falloff_angle></spot>"
        "</technique_common></light><light id=\"a\"><extra><technique profile=\"CGL\"><area>"
        "<color>5 5 5</color></area></technique></extra></light></library_lights>\n"
        "<library_effects><effect id=\"e\"><profile_COMMON><newparam sid=\"d\"><float4>.1 .2 .3 1"
        "</float4></newparam><technique><phong><emission><color>1 0 0 1</color></emission><diffuse>"
        "<param ref=\"d\"/></diffuse><transparent><color>1 1 1 1</color></transparent></phong>"
        "</technique></profile_COMMON></effect><effect id=\"g\"><extra><technique profile=\"CGL\">"
        "<glass><reflectance>1 1 1</reflectance><transmittance>1 1 1</transmittance><ior>1.45</ior>"
        "</glass></technique></extra></effect></library_effects>\n"
        "<library_materials><material id=\"m\"><instance_effect url=\"#e\"/></material>"
        "<material id=\"n\"><instance_effect url=\"#g\"/></material></library_materials>\n" +
        meshLibrary("0 0 0 1 0 0 1 1 0 0 1 0 0.5 0.5 -1 0.5 0.25 0", 18,
                    "<polylist material=\"M\" count=\"2\">" + std::string(kVertexInput) +
                        kNormalInput +
                        "<vcount>5 3</vcount><p>0 0 1 1 2 0 3 1 5 0 0 0 1 1 4 0</p></polylist>"
                        "<tristrips count=\"1\">" +
                        kVertexInput + "<p>0 1 2 3 4</p></tristrips><polygons count=\"1\">" +
                        kVertexInput + "<ph><p>0 1 2 3</p><h>0 1 2</h></ph></polygons>",
                    floats("nrm", "0 0 1 0.6 0 0.8", 6)) +
        "<library_geometries><geometry id=\"s\"><extra><technique profile=\"CGL\"><sphere><radius>"
        ".3</radius></sphere></technique></extra></geometry></library_geometries>\n"
        "<library_nodes><node id=\"k\"><skew>30 0 1 0 1 0 0</skew>"
        "<instance_geometry url=\"#s\"/></node></library_nodes>\n"
        "<library_controllers><controller id=\"w\"><skin source=\"#h\"><bind_shape_matrix>1 0 0 1 "
        "0 1 "
        "0 2 0 0 1 3 0 0 0 1</bind_shape_matrix><source id=\"j\"><Name_array id=\"ja\" "
        "count=\"1\">bone</Name_array></source><source id=\"b\"><float_array id=\"ba\" "
        "count=\"16\">"
        "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array></source><joints><input semantic=\"JOINT\" "
        "source=\"#j\"/><input semantic=\"INV_BIND_MATRIX\" source=\"#b\"/></joints></skin>"
        "</controller><controller id=\"h\"><morph source=\"#mesh\"/></controller>"
        "</library_controllers>\n";
    document.nodes =
        "<node id=\"p\"><matrix>1 0 0 4 0 1 0 5 0 0 1 6 0 0 0 1</matrix><rotate>0 0 1 30</rotate>"
        "<instance_geometry url=\"#mesh\"><bind_material><technique_common><instance_material "
        "symbol=\"M\" target=\"#m\"/></technique_common></bind_material></instance_geometry>"
        "<node id=\"q\"><scale>1 2 -1</scale><instance_light url=\"#l\"/>"
        "<instance_camera url=\"#c\"/><instance_node url=\"#k\"/></node></node>\n"
        "<node><lookat>1 2 3 0 0 0 0 1 0</lookat><instance_light url=\"#a\"/></node>"
        "<node id=\"r\"><node sid=\"bone\"/></node><node><instance_controller "
        "url=\"#w\"><skeleton>#r"
        "</skeleton></instance_controller></node>";
    return document.str();
}

/// What the renderer relies on.
void expectSound(const Scene& scene) {
    for (const Triangle& t : scene.triangles) {
        ASSERT_LT(t.material, scene.materials.size());
        ASSERT_LT(t.instance, scene.instances.size());
        for (int i = 0; i < 3; ++i) {
            ASSERT_LT(t.corner[i], scene.positions.size());
            ASSERT_TRUE(t.normals[i] == kNoNormals || t.normals[i] < scene.normals.size());
        }
        const float length = glm::length(scene.geometricNormal(t));
        ASSERT_NEAR(length, 1, 1e-5);
    }
    for (const glm::vec3& p : scene.positions)
        for (int i = 0; i < 3; ++i)
            ASSERT_LE(std::abs(p[i]), 1.2e18f);
    for (const glm::vec3& n : scene.normals)
        ASSERT_NEAR(glm::length(n), 1, 1e-5);
    for (const Sphere& s : scene.spheres) {
        ASSERT_GT(s.radius, 0);
        ASSERT_LT(s.material, scene.materials.size());
    }
    for (const Light& light : scene.lights) {
        ASSERT_TRUE(std::isfinite(light.color.x + light.color.y + light.color.z));
        ASSERT_TRUE(std::isfinite(glm::length(light.position)));
        ASSERT_NEAR(glm::length(light.direction), 1, 1e-5);
    }
    collectEmitters(scene);
}

struct Outcome {
    int scenes = 0, errors = 0;
    int forgiven = 0; ///< of the scenes, those of which something was replaced or left out

    void load(const std::string& text) {
        for (bool cs184 : {false, true}) {
            try {
                const Scene scene = loadText(text, conventionsOf(cs184));
                expectSound(scene);
                ++scenes;
                forgiven += !scene.report.forgiven.empty();
            } catch (const SceneError& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                ++errors;
            }
        }
    }
};

TEST(Mutations, TheOriginalLoads) {
    Outcome outcome;
    outcome.load(everything());
    EXPECT_EQ(outcome.scenes, 2);
    const Scene scene = loadText(everything());
    EXPECT_EQ(scene.triangles.size(), 2 * (3 + 1 + 3 + 2) + 2u); // a mesh, twice, and an area light
    EXPECT_EQ(scene.spheres.size(), 1u);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.cameras.size(), 1u);
}

TEST(Mutations, Truncations) {
    const std::string text = everything();
    Outcome outcome;
    for (size_t length = 0; length < text.size(); length += 3)
        outcome.load(text.substr(0, length));
    EXPECT_GT(outcome.errors, 2000);
}

TEST(Mutations, FlippedBytes) {
    std::mt19937 random(5);
    const std::string text = everything();
    Outcome outcome;
    for (int i = 0; i < 3000; ++i) {
        std::string damaged = text;
        for (int k = 0; k <= i % 3; ++k)
            damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
        outcome.load(damaged);
    }
    EXPECT_GT(outcome.scenes, 100);
    EXPECT_GT(outcome.errors, 100);
}

TEST(Mutations, FlippedBytesOfUtf16) {
    std::mt19937 random(9);
    std::string text = "\xFF\xFE";
    for (const char c : everything())
        text += std::string{c, '\0'};
    Outcome outcome;
    for (int i = 0; i < 1000; ++i) {
        std::string damaged = text.substr(0, text.size() - size_t(i % 5 == 0));
        damaged[random() % damaged.size()] ^= char(1u << (random() % 8));
        outcome.load(damaged);
    }
    EXPECT_GT(outcome.scenes, 100);
    EXPECT_GT(outcome.errors, 100);
}

TEST(Mutations, ChangedDigits) {
    std::mt19937 random(6);
    const std::string text = everything();
    std::vector<size_t> digits;
    for (size_t i = text.find("<asset>"); i < text.size(); ++i)
        if (std::isdigit(static_cast<unsigned char>(text[i]))) digits.push_back(i);
    Outcome outcome;
    for (int i = 0; i < 3000; ++i) {
        std::string damaged = text;
        for (int k = 0; k <= i % 4; ++k)
            damaged[digits[random() % digits.size()]] = "0123456789-.e"[random() % 13];
        outcome.load(damaged);
    }
    EXPECT_GT(outcome.scenes, 100);
    EXPECT_GT(outcome.forgiven, 100);
}

TEST(Mutations, MovedPieces) {
    // Cuts a random piece out, or inserts a copy of it elsewhere.
    std::mt19937 random(7);
    const std::string text = everything();
    Outcome outcome;
    for (int i = 0; i < 1500; ++i) {
        std::string damaged = text;
        const std::string piece = text.substr(random() % text.size(), random() % 200);
        if (i % 2)
            damaged.insert(random() % damaged.size(), piece);
        else
            damaged.erase(random() % damaged.size(), random() % 20);
        outcome.load(damaged);
    }
    EXPECT_GT(outcome.errors, 100);
}

TEST(Mutations, ExtremeNumbers) {
    // Replaces whole numbers by extreme ones.
    std::mt19937 random(8);
    const std::string text = everything();
    const char* const numbers[] = {"1e308", "-1e308", "1e-308",     "4294967295", "4294967296",
                                   "-1",    "NaN",    "1e39",       "1e19",       "1e-46",
                                   "0",     "-0",     "2147483648", "1e160",      "1e-160"};
    Outcome outcome;
    for (int i = 0; i < 3000; ++i) {
        size_t begin = 0;
        do
            begin = text.find_first_of(" >\"", 300 + random() % (text.size() - 400)) + 1;
        while (!std::isdigit(static_cast<unsigned char>(text[begin])));
        const size_t end = text.find_first_of(" <\"", begin);
        std::string damaged = text;
        damaged.replace(begin, end - begin, numbers[random() % std::size(numbers)]);
        outcome.load(damaged);
    }
    EXPECT_GT(outcome.scenes, 100);
    EXPECT_GT(outcome.forgiven, 100);
}

} // namespace
} // namespace stromboli::test
