#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

struct LightText {
    std::string common = "<point><color>1 2 3</color></point>";
    std::string dialect;
    std::string transforms;
    std::string asset;
};

Scene loadLight(const LightText& text, bool cs184 = false) {
    DocumentText document;
    document.asset = text.asset;
    const std::string extra =
        text.dialect.empty() ? ""
                             : "<extra><technique profile=\"blender\"><type>1</type></technique>"
                               "<technique profile=\"CGL\">" +
                                   text.dialect + "</technique></extra>";
    document.libraries = fmt::format("<library_lights><light id=\"l\" name=\"Light\">"
                                     "<technique_common>{}</technique_common>{}</light>"
                                     "</library_lights>",
                                     text.common, extra);
    document.nodes = fmt::format("<node>{}<instance_light url=\"#l\"/></node>", text.transforms);
    return load(document, cs184);
}

Light onlyLight(const LightText& text, bool cs184 = false) {
    const Scene scene = loadLight(text, cs184);
    EXPECT_EQ(scene.lights.size(), 1u);
    return scene.lights.at(0);
}

TEST(Lights, Point) {
    const Light light = onlyLight({.transforms = "<translate>4 5 6</translate>"});
    EXPECT_EQ(light.kind, LightKind::Point);
    EXPECT_EQ(light.name, "Light");
    EXPECT_EQ(light.color, glm::vec3(1, 2, 3));
    EXPECT_EQ(light.position, glm::vec3(4, 5, 6));
    EXPECT_EQ(light.constantAttenuation, 1);
    EXPECT_EQ(light.linearAttenuation, 0);
    EXPECT_EQ(light.quadraticAttenuation, 0);
}

TEST(Lights, AttenuationFollowsTheUnit) {
    const LightText text{.common = "<point><color>1 1 1</color><constant_attenuation>0.5"
                                   "</constant_attenuation><linear_attenuation>3"
                                   "</linear_attenuation><quadratic_attenuation>0.25"
                                   "</quadratic_attenuation></point>",
                         .transforms = "<translate>0 0 8</translate>",
                         .asset = "<unit meter=\"0.01\"/>"};
    const Light light = onlyLight(text);
    // The origin is 8 units = 0.08 m away.
    const double d = light.position.z;
    EXPECT_NEAR(d, 0.08, 1e-8);
    EXPECT_NEAR(light.constantAttenuation + light.linearAttenuation * d +
                    light.quadraticAttenuation * d * d,
                0.5 + 3 * 8 + 0.25 * 64, 1e-5);
    const Light cs184 = onlyLight(text, true);
    EXPECT_EQ(cs184.position.z, 8);
    EXPECT_EQ(cs184.constantAttenuation, 1);
    EXPECT_EQ(cs184.linearAttenuation, 0);
    EXPECT_EQ(cs184.quadraticAttenuation, 0);
}

TEST(Lights, DirectionalShinesAlongMinusZ) {
    const LightText text{.common = "<directional><color>1 1 1</color></directional>",
                         .transforms = "<translate>0 3 0</translate><rotate>1 0 0 -90</rotate>"
                                       "<scale>2 2 2</scale>"};
    expectNear(onlyLight(text).direction, {0, -1, 0});
    // T (0, 0, -1) is the point (0, 1, 0), taken as the direction to the light.
    expectNear(onlyLight(text, true).direction, {0, -1, 0});
    const LightText moved{.common = text.common, .transforms = "<translate>3 0 1</translate>"};
    expectNear(onlyLight(moved).direction, {0, 0, -1});
    expectNear(onlyLight(moved, true).direction, {-1, 0, 0});
}

TEST(Lights, Spot) {
    const std::string color = "<color>1 1 1</color>";
    const Light plain = onlyLight({.common = "<spot>" + color + "</spot>"});
    EXPECT_EQ(plain.kind, LightKind::Spot);
    EXPECT_NEAR(plain.falloffAngle, glm::radians(180.0), 1e-6);
    EXPECT_EQ(plain.falloffExponent, 0);
    expectNear(plain.direction, {0, 0, -1});
    const LightText text{.common = "<spot>" + color +
                                   "<quadratic_attenuation>2</quadratic_attenuation>"
                                   "<falloff_angle>45</falloff_angle>"
                                   "<falloff_exponent>3</falloff_exponent></spot>"};
    const Light light = onlyLight(text);
    EXPECT_NEAR(light.falloffAngle, glm::radians(45.0), 1e-6);
    EXPECT_EQ(light.falloffExponent, 3);
    EXPECT_EQ(light.quadraticAttenuation, 2);
    const Scene cs184 = loadLight(text, true);
    EXPECT_TRUE(cs184.lights.empty());
    EXPECT_THAT(cs184.report.ignored, Contains(HasSubstr("<spot>")));
}

TEST(Lights, Ambient) {
    for (const LightText& text :
         {LightText{.common = "<ambient><color>1 1 1</color></ambient>"},
          LightText{.dialect = "<ambient><color>1 1 1</color></ambient>"},
          LightText{.dialect = "<hemisphere><color>1 1 1</color></hemisphere>"}}) {
        EXPECT_EQ(onlyLight(text).kind, LightKind::Ambient);
        EXPECT_FALSE(onlyLight(text).upperHemisphereOnly);
        EXPECT_TRUE(onlyLight(text, true).upperHemisphereOnly);
    }
}

const LightText kArea{.dialect = "<area><color>10 10 10</color></area>",
                      .transforms = "<matrix>0.6 0 0 0 0 0.8 0 0 0 0 1 1.49 0 0 0 1</matrix>",
                      .asset = "<up_axis>Z_UP</up_axis>"};

TEST(Lights, AreaOfTheDialect) {
    const Light light = onlyLight(kArea, true);
    EXPECT_EQ(light.kind, LightKind::Area);
    EXPECT_EQ(light.color, glm::vec3(10));
    expectNear(light.position, {0, 1.49, 0});
    expectNear(light.direction, {0, -1, 0});
    expectNear(light.edgeX, {0.6, 0, 0});
    expectNear(light.edgeY, {0, 0, 0.8});
}

TEST(Lights, AreaBecomesGeometry) {
    const Scene scene = loadLight(kArea);
    EXPECT_TRUE(scene.lights.empty());
    ASSERT_EQ(scene.triangles.size(), 2u);
    for (const Triangle& t : scene.triangles) {
        expectNear(scene.geometricNormal(t), {0, -1, 0});
        EXPECT_EQ(scene.materials[t.material].emission, glm::vec3(10));
        EXPECT_FALSE(scene.materials[t.material].emitsBothSides);
    }
    expectNear(scene.bounds().extent(), {0.6, 0, 0.8});
    // Mirrored, it still shines along the node's -z.
    LightText mirrored = kArea;
    mirrored.transforms += "<scale>-1 1 1</scale>";
    for (const Scene& other : {loadLight(mirrored)})
        for (const Triangle& t : other.triangles)
            expectNear(other.geometricNormal(t), {0, -1, 0});
}

TEST(Lights, UnknownDialectLightsFallBack) {
    const LightText text{.dialect = "<environment><color>1 1 1</color></environment>"};
    EXPECT_EQ(onlyLight(text).kind, LightKind::Point);
    EXPECT_THAT(loadLight(text).report.ignored, Contains(HasSubstr("1 <environment>")));
}

TEST(Lights, WithoutPlaceInTheWorldTheyAreLeftOut) {
    for (const LightText& text :
         {LightText{.transforms = "<translate>1e19 0 0</translate>"},
          LightText{.common = "<directional><color>1 1 1</color></directional>",
          .transforms = "<scale>1 1 0</scale>"},
          LightText{.dialect = kArea.dialect, .transforms = "<scale>0 1 1</scale>"}}) {
        const Scene scene = loadLight(text);
        EXPECT_TRUE(scene.lights.empty());
        EXPECT_TRUE(scene.triangles.empty());
        EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("'Light' is left out")));
    }
}

TEST(Lights, NegativeColorsBecomeBlack) {
    const Scene scene = loadLight({.common = "<point><color>-1 2 3 1</color></point>"});
    EXPECT_EQ(scene.lights.at(0).color, glm::vec3(0, 2, 3));
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("negative")));
}

/// They are left out, and here nothing else is there.
TEST(Lights, WithoutAColorAreLeftOut) {
    for (const std::string& bad :
         {std::string("<point/>"), std::string("<point><color>1 1</color></point>"),
          std::string("<point><color>1 1 1 1 1</color></point>"),
          std::string("<point><color>1 1 1e39</color></point>"),
          std::string("<point><color>1 1 nan</color></point>")})
        EXPECT_THROW(loadLight({.common = bad}), SceneError) << bad;
    EXPECT_THROW(loadLight({.dialect = "<area/>"}), SceneError);
}

TEST(Lights, NumbersOutsideTheirRangeAreTheNearestInIt) {
    const auto light = [](const std::string& kind, const std::string& number) {
        const Scene scene =
            loadLight({.common = fmt::format("<{0}><color>1 1 1</color>{1}</{0}>", kind, number)});
        EXPECT_EQ(scene.report.forgiven.size(), 1u) << number;
        return scene.lights.at(0);
    };
    EXPECT_EQ(light("point", "<linear_attenuation>-1</linear_attenuation>").linearAttenuation, 0);
    EXPECT_EQ(light("point", "<constant_attenuation>0</constant_attenuation>").constantAttenuation,
              1);
    EXPECT_FLOAT_EQ(light("spot", "<falloff_angle>361</falloff_angle>").falloffAngle,
                    float(2 * 3.14159265358979323846));
    EXPECT_EQ(light("spot", "<falloff_exponent>-1</falloff_exponent>").falloffExponent, 0);
}

} // namespace
} // namespace stromboli::test
