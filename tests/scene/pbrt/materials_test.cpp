// Materials of both versions by their own defaults.

#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

/// All parts of the material of a triangle, each with its share.
std::vector<std::pair<Material, double>> partsOf(const Scene& scene) {
    std::vector<std::pair<Material, double>> parts;
    uint32_t number = scene.triangles.at(0).material;
    double left = 1;
    while (number != kNoMaterial) {
        const Material& m = scene.materials.at(number);
        parts.emplace_back(m, left * (1 - m.otherShare));
        left *= m.otherShare;
        number = m.other;
    }
    return parts;
}

void expectColor(const glm::vec3& a, const glm::vec3& b) {
    for (const int c : {0, 1, 2})
        EXPECT_NEAR(a[c], b[c], 1e-4) << c;
}

TEST(PbrtMaterials4, Diffuse) {
    expectColor(materialV4("Material \"diffuse\"").albedo, glm::vec3(0.5f));
    const Material m = materialV4("Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]");
    EXPECT_EQ(m.kind, MaterialKind::Diffuse);
    expectColor(m.albedo, {0.1f, 0.2f, 0.3f});
    EXPECT_FALSE(m.isBlackBehind);
}

TEST(PbrtMaterials4, Dielectrics) {
    const Material glass = materialV4("Material \"dielectric\"");
    EXPECT_EQ(glass.kind, MaterialKind::Dielectric);
    EXPECT_EQ(glass.ior, 1.5f);
    EXPECT_TRUE(glass.isSmooth());
    const Material rough = materialV4("Material \"dielectric\" \"float roughness\" .25 \"float "
                                      "eta\" 1.3");
    EXPECT_FLOAT_EQ(rough.facets.alpha.x, 0.5f); // the root
    EXPECT_EQ(rough.facets.distribution, FacetDistribution::Ggx);
    EXPECT_EQ(rough.facets.masking, FacetMasking::Correlated);
    EXPECT_FLOAT_EQ(materialV4("Material \"dielectric\" \"float roughness\" .25 \"bool "
                               "remaproughness\" false")
                        .facets.alpha.x,
                    0.25f);
    EXPECT_EQ(materialV4("Material \"thindielectric\"").kind, MaterialKind::ThinDielectric);
    EXPECT_NEAR(materialV4("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"").ior, 1.5168,
                1e-6);
}

TEST(PbrtMaterials4, Conductors) {
    const Material copper = materialV4("Material \"conductor\"");
    EXPECT_EQ(copper.kind, MaterialKind::Conductor);
    expectColor(copper.eta, {0.200438f, 0.924033f, 1.102212f});
    EXPECT_TRUE(copper.isSmooth());
    const Material silver = materialV4("Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" "
                                       "\"spectrum k\" \"metal-Ag-k\" \"float uroughness\" .04");
    expectColor(silver.eta, {0.155275f, 0.116723f, 0.138342f});
    EXPECT_FLOAT_EQ(silver.facets.alpha.x, 0.2f);
    EXPECT_EQ(silver.facets.alpha.y, 0);
    const Material stated = materialV4("Material \"conductor\" \"rgb reflectance\" [.25 .5 .75]");
    const glm::vec3 below = stated.eta - 1.0f, above = stated.eta + 1.0f, k2 = stated.k * stated.k;
    expectColor((below * below + k2) / (above * above + k2), {0.25f, 0.5f, 0.75f});
    // Spectra: one that is the same everywhere reflects as much in all channels.
    const Material flat = materialV4("Material \"conductor\" \"spectrum eta\" [300 2 900 2] "
                                     "\"spectrum k\" [300 3 900 3]");
    expectColor(flat.eta, glm::vec3(2));
    expectColor(flat.k, glm::vec3(3));
}

TEST(PbrtMaterials4, CoatedDiffuseIsPlasticWithADarkerBase) {
    const Material clear = materialV4("Material \"coateddiffuse\" \"float thickness\" 0 \"integer "
                                      "maxdepth\" 1000 \"rgb reflectance\" [.2 .4 .8]");
    EXPECT_EQ(clear.kind, MaterialKind::Plastic);
    EXPECT_TRUE(clear.isNonlinear);
    expectColor(clear.albedo, {0.2f, 0.4f, 0.8f});
    const Material usual = materialV4("Material \"coateddiffuse\"");
    EXPECT_LT(usual.albedo.x, 0.5f);
    EXPECT_GT(usual.albedo.x, 0.47f);
    EXPECT_EQ(usual.ior, 1.5f);
}

TEST(PbrtMaterials4, DiffuseTransmissionIsASum) {
    const auto parts =
        partsOf(loadV4("Material \"diffusetransmission\" \"rgb reflectance\" [.3 .3 .1] \"rgb "
                       "transmittance\" [.1 .1 .1]" +
                       std::string(kTriangle)));
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[1].first.kind, MaterialKind::Burley);
    expectColor(parts[0].first.albedo * float(parts[0].second), {0.3f, 0.3f, 0.1f});
    expectColor(parts[1].first.burley.baseColor * float(parts[1].second), glm::vec3(0.1f));
}

TEST(PbrtMaterials4, OthersAreReplacedAndSaid) {
    for (const char* kind : {"coatedconductor", "hair", "measured"})
        EXPECT_THAT(problemInV4(fmt::format("Material \"{}\" {}", kind, kTriangle)),
                    HasSubstr(fmt::format("'{}' is no material that exists here", kind)));
    EXPECT_THAT(problemInV4("Material \"velvet\"" + std::string(kTriangle)),
                HasSubstr("<Material \"velvet\">: 'velvet' is no material that is read"));
    EXPECT_THAT(problemInV4("Material \"diffuse\" \"float shine\" 1" + std::string(kTriangle)),
                HasSubstr("has 'shine', which nothing reads"));
    EXPECT_EQ(materialV4("Material \"coatedconductor\"").principled.clearcoat, 1);
}

/// The coat of glTF has the index 1.5: of another one it is a share, which reflects as much when it
/// is looked at straight.
TEST(PbrtMaterials4, CoatedConductorsHaveAThicknessAndAnIndex) {
    const auto made = [](const std::string& more) {
        return materialV4("Material \"coatedconductor\" \"rgb reflectance\" [.5 .5 .5] " + more)
            .principled;
    };
    EXPECT_FLOAT_EQ(made("").clearcoat, 1);
    const PrincipledParameters clear = made("\"float thickness\" 0"),
                               thick = made("\"float thickness\" .5");
    EXPECT_NEAR(thick.baseColor.x / clear.baseColor.x, std::exp(-2 * 0.5), 1e-5);
    const double f = std::pow(0.33 / 2.33, 2);
    EXPECT_NEAR(made("\"float interface.eta\" 1.33").clearcoat, f / 0.04, 1e-5);
    // Spectra of indices, by name and as wavelengths with values.
    EXPECT_NEAR(made("\"spectrum interface.eta\" [300 1.33 900 1.33]").clearcoat, f / 0.04, 1e-3);
    const glm::vec3 heavy = made("\"spectrum interface.eta\" \"glass-LASF9\"").baseColor;
    EXPECT_NEAR(heavy.x, made("\"float interface.eta\" 1.85025").baseColor.x, 1e-5);
    EXPECT_NE(heavy.x, made("").baseColor.x);
}

/// Names are those of the whole scene.
TEST(PbrtMaterials4, MayBeNamedBeforeTheyAreMade) {
    const std::string world =
        std::string("NamedMaterial \"red\"") + kTriangle +
        "MakeNamedMaterial \"red\" \"string type\" \"diffuse\" \"rgb reflectance\" [.8 .1 .1] ";
    const Scene scene = loadV4(world);
    expectColor(scene.materials.at(scene.triangles.at(0).material).albedo, {0.8f, 0.1f, 0.1f});
    EXPECT_EQ(problemInV4(world), "");
    EXPECT_THAT(loadV3(world + "WorldEnd Material \"matte\"").report.forgiven,
                Contains(HasSubstr("names the material 'red'")));
}

TEST(PbrtMaterials4, WithoutTheirReliefAreWhatTheyAre) {
    const std::string world =
        "Material \"diffuse\" \"rgb reflectance\" [.8 .1 .1] \"string normalmap\" \"none.png\"";
    expectColor(materialV4(world).albedo, {0.8f, 0.1f, 0.1f});
    EXPECT_THAT(problemInV4(world + kTriangle),
                HasSubstr("names the file 'none.png', which is not there"));
}

TEST(PbrtMaterials4, AnInterfaceIsNotThere) {
    EXPECT_EQ(materialV4("Material \"interface\"").opacity, 0);
    EXPECT_EQ(materialV3("Material \"\"").opacity, 0);
    EXPECT_EQ(materialV3("Material \"none\"").opacity, 0);
}

TEST(PbrtMaterials4, MixesHaveTheShareOfTheSecond) {
    const std::string named = "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb "
                              "reflectance\" [1 0 0] MakeNamedMaterial \"b\" \"string type\" "
                              "\"diffuse\" \"rgb reflectance\" [0 1 0] ";
    const auto v4 = partsOf(loadV4(named +
                                   "Material \"mix\" \"string materials\" [\"a\" \"b\"] "
                                   "\"float amount\" .25" +
                                   kTriangle));
    ASSERT_EQ(v4.size(), 2u);
    EXPECT_EQ(v4[0].first.albedo.x, 1);
    EXPECT_NEAR(v4[0].second, 0.75, 1e-6);
    // In pbrt-v3 it is that of the first one.
    const auto v3 = partsOf(loadV3(
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" \"rgb Kd\" [1 0 0] MakeNamedMaterial "
        "\"b\" \"string type\" \"matte\" Material \"mix\" \"string namedmaterial1\" \"a\" "
        "\"string namedmaterial2\" \"b\" \"rgb amount\" [.25 .25 .25]" +
        std::string(kTriangle)));
    ASSERT_EQ(v3.size(), 2u);
    EXPECT_EQ(v3[0].first.albedo.x, 1);
    EXPECT_NEAR(v3[0].second, 0.25, 1e-6);
    EXPECT_THAT(
        problemInV4("Material \"mix\" \"string materials\" [\"a\" \"b\"]" + std::string(kTriangle)),
        HasSubstr("names the material 'a', which is not there"));
}

TEST(PbrtMaterials4, NamedOnesAreThoseOfTheScene) {
    const std::string inside = "AttributeBegin MakeNamedMaterial \"a\" \"string type\" \"mirror\" "
                               "AttributeEnd NamedMaterial \"a\" ";
    EXPECT_EQ(materialV4("Material \"diffuse\" " + inside).kind, MaterialKind::Conductor);
    // In pbrt-v3 they end with their block, and the default stays.
    EXPECT_EQ(materialV3(inside).kind, MaterialKind::Diffuse);
}

TEST(PbrtMaterials4, MayReferToWhatComesLater) {
    const Scene scene =
        loadV4("Material \"mix\" \"string materials\" [\"a\" \"b\"] MakeNamedMaterial \"b\" "
               "\"string type\" \"diffuse\" MakeNamedMaterial \"a\" \"string type\" \"diffuse\" "
               "\"texture reflectance\" \"t\" Texture \"t\" \"spectrum\" \"constant\" \"rgb "
               "value\" [.1 .2 .3]" +
               std::string(kTriangle));
    expectColor(partsOf(scene).at(0).first.albedo, {0.1f, 0.2f, 0.3f});
}

TEST(PbrtMaterials4, AttributesAreDefaults) {
    const std::string text = "Attribute \"material\" \"rgb reflectance\" [.9 .9 .9] ";
    expectColor(materialV4(text + "Material \"diffuse\"").albedo, glm::vec3(0.9f));
    expectColor(materialV4(text + "Material \"diffuse\" \"rgb reflectance\" [.1 .1 .1]").albedo,
                glm::vec3(0.1f));
}

TEST(PbrtColors, OfOtherSpacesBecomeRec709) {
    const Material m = materialV4("ColorSpace \"rec2020\" Material \"diffuse\" \"rgb reflectance\" "
                                  "[.5 .5 .5]");
    expectColor(m.albedo, glm::vec3(0.5f));
    const Material red = materialV4("ColorSpace \"dci-p3\" Material \"diffuse\" \"rgb "
                                    "reflectance\" [.5 0 0]");
    EXPECT_GT(red.albedo.x, 0.55f);
    EXPECT_THAT(problemInV4("ColorSpace \"cmyk\""), HasSubstr("expected srgb"));
}

TEST(PbrtColors, SpectraOfReflectance) {
    expectColor(
        materialV4("Material \"diffuse\" \"spectrum reflectance\" [300 .25 900 .25]").albedo,
        glm::vec3(0.25f));
    writeFile("green.spd", "# green\n400 0\n490 0\n510 1\n600 1\n610 0\n");
    const Material green =
        materialV4("Material \"diffuse\" \"spectrum reflectance\" \"green.spd\"");
    EXPECT_GT(green.albedo.y, 0.7f);
    EXPECT_LT(green.albedo.z, 0.2f);
    EXPECT_THAT(problemInV4("Material \"diffuse\" \"spectrum reflectance\" \"no.spd\"" +
                            std::string(kTriangle)),
                HasSubstr("which is not there"));
}

TEST(PbrtMaterials3, Defaults) {
    expectColor(materialV3("Material \"matte\"").albedo, glm::vec3(0.5f));
    const Material mirror = materialV3("Material \"mirror\"");
    expectColor(mirror.reflectance, glm::vec3(0.9f));
    EXPECT_TRUE(mirror.isSmooth());
    const Material glass = materialV3("Material \"glass\" \"float index\" 1.4");
    EXPECT_EQ(glass.ior, 1.4f);
    EXPECT_TRUE(glass.isSmooth());
    // pbrt-v3's polynomial at its default of 0.01.
    EXPECT_NEAR(materialV3("Material \"metal\"").facets.alpha.x, 0.1383, 1e-3);
    const Material disney = materialV3("Material \"disney\"");
    EXPECT_EQ(disney.kind, MaterialKind::Burley);
    EXPECT_EQ(disney.burley.sheenTint, 0.5f);
    EXPECT_EQ(disney.burley.clearcoatGloss, 1);
    EXPECT_EQ(disney.burley.roughness, 0.5f);
    EXPECT_EQ(materialV3("Material \"substrate\"").kind, MaterialKind::Principled);
}

TEST(PbrtMaterials3, PlasticIsASumOfTwo) {
    const auto parts =
        partsOf(loadV3("Material \"plastic\" \"rgb Kd\" [.2 .4 .6] \"rgb Ks\" [.1 .2 .3]" +
                       std::string(kTriangle)));
    ASSERT_EQ(parts.size(), 2u);
    expectColor(parts[0].first.albedo * float(parts[0].second), {0.2f, 0.4f, 0.6f});
    EXPECT_LE(parts[0].first.albedo.z, 1.0f);
    const Material& gloss = parts[1].first;
    EXPECT_EQ(gloss.kind, MaterialKind::Plastic);
    expectColor(gloss.albedo, glm::vec3(0));
    expectColor(gloss.reflectance * float(parts[1].second), {0.1f, 0.2f, 0.3f});
    EXPECT_NEAR(gloss.facets.alpha.x, 0.4618, 1e-3);
}

TEST(PbrtMaterials3, UberHasAllLobes) {
    const Scene scene = loadV3("Material \"uber\" \"rgb Kr\" [.2 .2 .2] \"rgb Kt\" [.1 .1 .1] "
                               "\"rgb opacity\" [.5 .5 .5]" +
                               std::string(kTriangle));
    const auto parts = partsOf(scene);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].first.alphaMode, AlphaMode::Blend);
    EXPECT_FLOAT_EQ(parts[0].first.opacity, 0.5f);
    EXPECT_EQ(parts[2].first.kind, MaterialKind::Dielectric);
    expectColor(parts[2].first.reflectance * float(parts[2].second), glm::vec3(0.2f));
    double sum = 0;
    for (const auto& [material, share] : parts)
        sum += share;
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(PbrtMaterials3, TranslucentReflectsAndTransmits) {
    const auto parts = partsOf(loadV3("Material \"translucent\"" + std::string(kTriangle)));
    ASSERT_EQ(parts.size(), 3u);
    expectColor(parts[0].first.albedo * float(parts[0].second), glm::vec3(0.125f));
    expectColor(parts[1].first.burley.baseColor * float(parts[1].second), glm::vec3(0.125f));
    expectColor(parts[2].first.transmittance * float(parts[2].second), glm::vec3(0.125f));
}

TEST(PbrtMaterials3, ShapesOverrideThem) {
    const Scene scene = loadV3("Material \"matte\" \"rgb Kd\" [1 0 0] Shape \"sphere\" \"rgb Kd\" "
                               "[0 1 0] Shape \"sphere\"");
    ASSERT_EQ(scene.spheres.size(), 2u);
    expectColor(scene.materials[scene.spheres[0].material].albedo, {0, 1, 0});
    expectColor(scene.materials[scene.spheres[1].material].albedo, {1, 0, 0});
    EXPECT_THAT(problemInV4("Shape \"sphere\" \"rgb Kd\" [0 1 0]"),
                HasSubstr("has 'Kd', which nothing reads"));
}

TEST(PbrtMaterials3, ShapesOverrideTheDefaultOne) {
    const Scene scene = loadV3("Shape \"sphere\" \"rgb Kd\" [0 1 0] \"float gloss\" 1");
    expectColor(scene.materials[scene.spheres.at(0).material].albedo, {0, 1, 0});
    EXPECT_THAT(scene.report.forgiven.at(0),
                HasSubstr("scene.pbrt:1: <Shape \"sphere\">: has 'gloss', which nothing reads"));
}

TEST(PbrtMaterials3, XyzAndBlackbodyAreColours) {
    expectColor(materialV3("Material \"matte\" \"xyz Kd\" [.475228 .5 .544377]").albedo,
                glm::vec3(0.5f));
    const Material warm = materialV3("Material \"matte\" \"blackbody Kd\" [3000 .3]");
    EXPECT_GT(warm.albedo.x, warm.albedo.z);
}

} // namespace
} // namespace stromboli::test
