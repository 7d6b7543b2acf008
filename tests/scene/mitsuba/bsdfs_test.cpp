// What surfaces are made of.

#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

std::string rectangleOf(const std::string& bsdf) {
    return "<shape type=\"rectangle\">" + bsdf + "</shape>";
}

Scene sceneOf(const std::string& bsdf) {
    return loadInside(rectangleOf(bsdf));
}

Material materialOf(const std::string& bsdf) {
    const Scene scene = sceneOf(bsdf);
    return scene.materials.at(scene.triangles.at(0).material);
}

TEST(MitsubaBsdfs, Diffuse) {
    EXPECT_EQ(materialOf("").albedo, glm::vec3(0.5f));
    EXPECT_EQ(materialOf("<bsdf type=\"diffuse\"/>").albedo, glm::vec3(0.5f));
    EXPECT_EQ(materialOf("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
                         "value=\"0.25, 0.5 1\"/></bsdf>")
                  .albedo,
              glm::vec3(0.25f, 0.5f, 1));
    EXPECT_EQ(materialOf("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0.25\"/>"
                         "</bsdf>")
                  .albedo,
              glm::vec3(0.25f));
    EXPECT_EQ(materialOf("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>").albedo,
              glm::vec3(0.5f));
}

TEST(MitsubaBsdfs, BlackBacksAreSaidNotToBe) {
    const auto said = [](const std::string& bsdf) { return sceneOf(bsdf).report.assumed; };
    const auto aboutBacks = testing::Contains(HasSubstr("alike on both sides"));
    EXPECT_THAT(said("<bsdf type=\"diffuse\"/>"), aboutBacks);
    EXPECT_THAT(said("<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>"),
                testing::Not(aboutBacks));
    EXPECT_THAT(said("<bsdf type=\"dielectric\"/>"), testing::Not(aboutBacks));
}

TEST(MitsubaBsdfs, Dielectrics) {
    const Material glass = materialOf("<bsdf type=\"dielectric\"/>");
    EXPECT_EQ(glass.kind, MaterialKind::Dielectric);
    EXPECT_TRUE(glass.isSmooth());
    EXPECT_FLOAT_EQ(glass.ior, 1.5046f / 1.000277f);
    const Material rough = materialOf(
        "<bsdf type=\"roughdielectric\"><string name=\"int_ior\" value=\"diamond\"/>"
        "<float name=\"ext_ior\" value=\"1\"/><string name=\"distribution\" value=\"ggx\"/>"
        "<float name=\"alpha_u\" value=\"0.2\"/></bsdf>");
    EXPECT_FLOAT_EQ(rough.ior, 2.419f);
    EXPECT_EQ(rough.facets.distribution, FacetDistribution::Ggx);
    EXPECT_EQ(rough.facets.alpha, glm::vec2(0.2f, 0.1f));
    EXPECT_EQ(materialOf("<bsdf type=\"thindielectric\"/>").kind, MaterialKind::ThinDielectric);
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"dielectric\"><string name=\"int_ior\" "
                                          "value=\"mud\"/></bsdf>")),
                HasSubstr("2: <string>: 'int_ior' is 'mud', expected a number or one of vacuum"));
}

TEST(MitsubaBsdfs, Conductors) {
    const Material mirror = materialOf("<bsdf type=\"conductor\"/>");
    EXPECT_EQ(mirror.kind, MaterialKind::Conductor);
    EXPECT_EQ(mirror.eta, glm::vec3(0));
    EXPECT_EQ(mirror.k, glm::vec3(1));
    const Material gold = materialOf("<bsdf type=\"roughconductor\"><string name=\"material\" "
                                     "value=\"Au\"/><float name=\"alpha\" value=\"0.3\"/></bsdf>");
    EXPECT_FLOAT_EQ(gold.k.x, 3.98316f);
    EXPECT_EQ(gold.facets.distribution, FacetDistribution::Beckmann);
    EXPECT_EQ(gold.facets.alpha, glm::vec2(0.3f));
    EXPECT_EQ(materialOf("<bsdf type=\"conductor\"><spectrum name=\"eta\" value=\"0.789\"/>"
                         "<spectrum name=\"k\" value=\"6.15\"/></bsdf>")
                  .k,
              glm::vec3(6.15f));
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"conductor\"><string name=\"material\" "
                                          "value=\"Xy\"/></bsdf>")),
                HasSubstr("is 'Xy', expected one of none, Ag, Al, Au, Cu, or eta and k"));
}

TEST(MitsubaBsdfs, Plastics) {
    const Material plastic = materialOf("<bsdf type=\"roughplastic\"><boolean name=\"nonlinear\" "
                                        "value=\"true\"/></bsdf>");
    EXPECT_EQ(plastic.kind, MaterialKind::Plastic);
    EXPECT_TRUE(plastic.isNonlinear);
    EXPECT_FLOAT_EQ(plastic.ior, 1.49f / 1.000277f);
    EXPECT_EQ(plastic.facets.alpha.x, 0.1f);
}

TEST(MitsubaBsdfs, BumpsAreHeights) {
    const std::string board = "<texture type=\"checkerboard\" name=\"any\"/>";
    const Material m = materialOf("<bsdf type=\"bumpmap\"><float name=\"scale\" value=\"0.25\"/>" +
                                  board + "<bsdf type=\"diffuse\"/></bsdf>");
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::Height);
    EXPECT_EQ(m.textures[0].scale, 0.25f);
    const auto problem = [](const std::string& inside) {
        return problemInside(rectangleOf("<bsdf type=\"bumpmap\">" + inside + "</bsdf>"));
    };
    EXPECT_THAT(problem("<bsdf type=\"diffuse\"/>"), HasSubstr("has no texture inside"));
    EXPECT_THAT(problem(board + board + "<bsdf type=\"diffuse\"/>"),
                HasSubstr("is the second texture of this bsdf"));
    EXPECT_THAT(
        problem(board + "<bsdf type=\"bumpmap\">" + board + "<bsdf type=\"diffuse\"/></bsdf>"),
        HasSubstr("is a bump map over another map of normals"));
}

/// Burley's index of a specular of 0.5 has 4 % at normal incidence: 1.5.
TEST(MitsubaBsdfs, PrincipledAndWhatItLacks) {
    const Scene scene = sceneOf("<bsdf type=\"principled\"><float name=\"metallic\" value=\"1\"/>"
                                "<float name=\"sheen\" value=\"1\"/></bsdf>");
    const PrincipledParameters& p = scene.materials.at(0).principled;
    EXPECT_EQ(p.metallic, 1);
    EXPECT_FLOAT_EQ(p.ior, 1.5f);
    EXPECT_THAT(scene.report.warnings,
                testing::Contains(HasSubstr("'sheen' has no counterpart here")));
}

TEST(MitsubaBsdfs, MasksAreOpacity) {
    const Material half = materialOf("<bsdf type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>");
    EXPECT_EQ(half.alphaMode, AlphaMode::Blend);
    EXPECT_EQ(half.opacity, 0.5f);
    EXPECT_EQ(materialOf("<bsdf type=\"null\"/>").opacity, 0);
    const Scene masked = sceneOf("<bsdf type=\"mask\"><texture name=\"opacity\" "
                                 "type=\"checkerboard\"><float name=\"color0\" value=\"1\"/>"
                                 "<float name=\"color1\" value=\"0\"/></texture>"
                                 "<bsdf type=\"diffuse\"/></bsdf>");
    const TextureImage& image = masked.images.at(0);
    const auto alpha = [&](size_t i) { return glm::unpackHalf2x16(image.words[2 * i + 1]).y; };
    EXPECT_NEAR(alpha(0), 1, 1e-3);
    EXPECT_EQ(alpha(1), 0);
    EXPECT_EQ(glm::unpackHalf2x16(image.words[2]).x, 1); // colours stay
}

TEST(MitsubaBsdfs, TexturesAreTransformed) {
    const Scene scene =
        sceneOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"checkerboard\">"
                "<transform name=\"to_uv\"><scale x=\"10\" y=\"20\"/>"
                "<translate x=\"0.5\"/></transform></texture></bsdf>");
    const TextureUse& use = scene.materials.at(0).textures.at(0);
    EXPECT_EQ(use.uRow, glm::vec3(10, 0, 0.5f));
    EXPECT_EQ(use.vRow, glm::vec3(0, 20, 0));
    EXPECT_TRUE(scene.textures.at(0).nearest);
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(1));
}

TEST(MitsubaBsdfs, UnknownOnesAreNamed) {
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"velvet\"/>")),
                HasSubstr("2: <bsdf>: 'velvet' is no bsdf that is read, expected diffuse"));
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" "
                                          "type=\"noise\"/></bsdf>")),
                HasSubstr("'noise' is no texture that is read"));
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"diffuse\"><rgb name=\"color\" "
                                          "value=\"1\"/></bsdf>")),
                HasSubstr("'color' is not read in bsdf 'diffuse'; expected one of reflectance"));
}

} // namespace
} // namespace stromboli::test
