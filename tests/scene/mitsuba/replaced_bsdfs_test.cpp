// BSDFs of Mitsuba 0.x that do not exist here, and what takes their place.

#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A surface by a share of cases: the share, and what is there.
using Part = std::pair<double, Material>;

struct Found {
    std::vector<Part> parts;
    std::vector<std::string> forgiven;
};

Found partsOf(const std::string& bsdf) {
    const Scene scene = loadOld("<shape type=\"rectangle\">" + bsdf + "</shape>");
    Found found{{}, scene.report.forgiven};
    double rest = 1;
    for (uint32_t i = scene.triangles.at(0).material; i != kNoMaterial;) {
        const Material& m = scene.materials.at(i);
        const double other = m.other == kNoMaterial ? 0 : double(m.otherShare);
        found.parts.emplace_back(rest * (1 - other), m);
        rest *= other;
        i = m.other;
    }
    return found;
}

/// The sum of what all parts of a kind reflect.
glm::dvec3 reflectedBy(const Found& found, MaterialKind kind) {
    glm::dvec3 sum(0.0);
    for (const auto& [share, m] : found.parts)
        if (m.kind == kind)
            sum += share * glm::dvec3(kind == MaterialKind::Diffuse ? m.albedo : m.reflectance);
    return sum;
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected) {
    EXPECT_LT(glm::distance(found, expected), 1e-6) << found.x << ' ' << found.y << ' ' << found.z;
}

TEST(MitsubaReplacedBsdfs, PhongIsASumOfLobes) {
    const Found found = partsOf("<bsdf type=\"phong\"><rgb name=\"diffuseReflectance\" "
                                "value=\"0.1 0.2 0.6\"/><rgb name=\"specularReflectance\" "
                                "value=\"0.3 0.2 0.1\"/><float name=\"exponent\" "
                                "value=\"40\"/></bsdf>");
    EXPECT_EQ(found.parts.size(), 2u);
    expectNear(reflectedBy(found, MaterialKind::Diffuse), {0.1, 0.2, 0.6});
    expectNear(reflectedBy(found, MaterialKind::Conductor), {0.3, 0.2, 0.1});
    for (const auto& [share, m] : found.parts) {
        EXPECT_TRUE(m.isBlackBehind);
        if (m.kind == MaterialKind::Conductor) {
            EXPECT_NEAR(m.facets.alpha.x, 1 / std::sqrt(81.0), 1e-6);
        }
    }
    EXPECT_THAT(found.forgiven, Contains(HasSubstr("'phong' is no bsdf that is read")));
    const Found usual = partsOf("<bsdf type=\"phong\"/>");
    expectNear(reflectedBy(usual, MaterialKind::Diffuse), glm::dvec3(0.5));
    expectNear(reflectedBy(usual, MaterialKind::Conductor), glm::dvec3(0.2));
}

/// More than all light is never reflected: the parts keep their proportion.
TEST(MitsubaReplacedBsdfs, SumsStayBelowOne) {
    const Found found = partsOf("<bsdf type=\"ward\"><spectrum name=\"diffuseReflectance\" "
                                "value=\"0.9\"/><spectrum name=\"specularReflectance\" "
                                "value=\"0.6\"/></bsdf>");
    expectNear(reflectedBy(found, MaterialKind::Diffuse), glm::dvec3(0.6));
    expectNear(reflectedBy(found, MaterialKind::Conductor), glm::dvec3(0.4));
}

TEST(MitsubaReplacedBsdfs, WardHasBeckmannsFacets) {
    const Found found = partsOf("<bsdf type=\"ward\"><spectrum name=\"diffuseReflectance\" "
                                "value=\"0\"/><string name=\"variant\" value=\"ward\"/>"
                                "<float name=\"alphaU\" value=\"0.3\"/></bsdf>");
    ASSERT_EQ(found.parts.size(), 1u);
    const Material& m = found.parts[0].second;
    EXPECT_EQ(m.kind, MaterialKind::Conductor);
    EXPECT_EQ(m.facets.distribution, FacetDistribution::Beckmann);
    EXPECT_EQ(m.facets.alpha, glm::vec2(0.3f, 0.1f));
    EXPECT_EQ(m.reflectance, glm::vec3(0.2f));
    EXPECT_EQ(found.forgiven.size(), 1u);
}

/// The largest texel counts: white times the rest is all the light that there is.
TEST(MitsubaReplacedBsdfs, PicturesKeepTheirPartOfTheSum) {
    const std::string name = writePicture("grey.tga", 1, 1, {{255, 0, 0, 255}});
    const Found found = partsOf("<bsdf type=\"phong\"><texture type=\"bitmap\" "
                                "name=\"diffuseReflectance\"><string name=\"filename\" value=\"" +
                                name + "\"/></texture></bsdf>");
    expectNear(reflectedBy(found, MaterialKind::Diffuse), glm::dvec3(1 / 1.2));
    expectNear(reflectedBy(found, MaterialKind::Conductor), glm::dvec3(0.2 / 1.2));
}

TEST(MitsubaReplacedBsdfs, RoughDiffuseIsDiffuse) {
    const Found found = partsOf("<bsdf type=\"roughdiffuse\"><spectrum name=\"reflectance\" "
                                "value=\"0.25\"/><float name=\"alpha\" value=\"1\"/></bsdf>");
    expectNear(reflectedBy(found, MaterialKind::Diffuse), glm::dvec3(0.25));
    EXPECT_THAT(found.forgiven, Contains(HasSubstr("diffuse of the same reflectance")));
}

TEST(MitsubaReplacedBsdfs, DiffuseTransmitters) {
    const Found found = partsOf("<bsdf type=\"difftrans\"><spectrum name=\"transmittance\" "
                                "value=\"0.25\"/></bsdf>");
    const Material& m = found.parts.at(0).second;
    EXPECT_EQ(m.kind, MaterialKind::Burley);
    EXPECT_TRUE(m.burley.isThin);
    EXPECT_EQ(m.burley.diffuseTransmission, 1);
    EXPECT_EQ(m.burley.baseColor, glm::vec3(0.25f));
    EXPECT_FALSE(m.isBlackBehind);
    EXPECT_THAT(found.forgiven, IsEmpty()); // exactly that
}

/// An interface of 1.5 sends 59.6 % of diffuse light from inside back (Duntley 1942), which a
/// coating loses; light goes twice through the layer.
TEST(MitsubaReplacedBsdfs, CoatingsOfDiffuseBases) {
    const std::string base = "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
                             "value=\"0.8\"/></bsdf>";
    const std::string ior = "<float name=\"intIOR\" value=\"1.5\"/><float name=\"extIOR\" "
                            "value=\"1\"/>";
    const Material m =
        partsOf("<bsdf type=\"coating\">" + ior + base + "</bsdf>").parts.at(0).second;
    EXPECT_EQ(m.kind, MaterialKind::Plastic);
    EXPECT_TRUE(m.isSmooth());
    EXPECT_EQ(m.ior, 1.5f);
    EXPECT_NEAR(m.albedo.x, 0.8 * (1 - 0.596), 0.001);
    const Material dyed = partsOf("<bsdf type=\"roughcoating\">" + ior +
                                  "<spectrum name=\"sigmaA\" value=\"0.5\"/><float "
                                  "name=\"thickness\" value=\"2\"/>" +
                                  base + "</bsdf>")
                              .parts.at(0)
                              .second;
    EXPECT_NEAR(dyed.albedo.x / m.albedo.x, std::exp(-2.0), 1e-6);
    EXPECT_FLOAT_EQ(dyed.facets.alpha.x, 0.1f);
}

TEST(MitsubaReplacedBsdfs, CoatingsOfMetals) {
    const Found found = partsOf("<bsdf type=\"coating\"><bsdf type=\"roughconductor\"><string "
                                "name=\"material\" value=\"none\"/><float name=\"alpha\" "
                                "value=\"0.25\"/><spectrum name=\"specularReflectance\" "
                                "value=\"0.5\"/></bsdf></bsdf>");
    const Material& m = found.parts.at(0).second;
    EXPECT_EQ(m.kind, MaterialKind::Principled);
    EXPECT_EQ(m.principled.baseColor, glm::vec3(0.5f));
    EXPECT_EQ(m.principled.clearcoat, 1);
    EXPECT_FLOAT_EQ(m.principled.roughness, 0.5f); // glTF's, whose square is alpha
    EXPECT_THAT(partsOf("<bsdf type=\"coating\"><bsdf type=\"conductor\"/></bsdf>").forgiven,
                Contains(HasSubstr("what is under it")));
}

TEST(MitsubaReplacedBsdfs, MixturesHaveWeights) {
    const auto diffuse = [](double r) {
        return fmt::format("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
                           "value=\"{}\"/></bsdf>",
                           r);
    };
    const std::string inside = diffuse(0.8) + "<bsdf type=\"plastic\"/>" + diffuse(0.4);
    const auto shareOf = [](const Found& found, MaterialKind kind, float albedo) {
        double share = 0;
        for (const Part& part : found.parts)
            if (part.second.kind == kind && part.second.albedo.x == albedo) share += part.first;
        return share;
    };
    const Found found = partsOf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" "
                                "value=\"0.5, 0.3, 0.2\"/>" +
                                inside + "</bsdf>");
    EXPECT_NEAR(shareOf(found, MaterialKind::Diffuse, 0.8f), 0.5, 1e-6);
    EXPECT_NEAR(shareOf(found, MaterialKind::Plastic, 0.5f), 0.3, 1e-6);
    EXPECT_NEAR(shareOf(found, MaterialKind::Diffuse, 0.4f), 0.2, 1e-6);
    EXPECT_THAT(found.forgiven, IsEmpty());
    // Where weights are less than 1, the rest is black; where they are more, they are shares.
    const Found less = partsOf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" "
                               "value=\"0.25 0.25 0\"/>" +
                               inside + "</bsdf>");
    EXPECT_NEAR(shareOf(less, MaterialKind::Diffuse, 0.8f), 0.25, 1e-6);
    EXPECT_NEAR(shareOf(less, MaterialKind::Diffuse, 0), 0.5, 1e-6);
    const Found more = partsOf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" "
                               "value=\"1 1 2\"/>" +
                               inside + "</bsdf>");
    EXPECT_NEAR(shareOf(more, MaterialKind::Diffuse, 0.4f), 0.5, 1e-6);
}

/// What is scattered once in a deep layer, and all of what comes through a thin one.
TEST(MitsubaReplacedBsdfs, ScatteringLayers) {
    const auto layer = [](const std::string& inside) {
        return partsOf("<bsdf type=\"hk\">" + inside + "</bsdf>").parts.at(0).second;
    };
    const Material thin = layer("<spectrum name=\"sigmaS\" value=\"1\"/><spectrum name=\"sigmaA\" "
                                "value=\"1\"/><float name=\"thickness\" value=\"0.5\"/>"
                                "<phase type=\"hg\"/>");
    EXPECT_NEAR(thin.albedo.x, 0.5 * 0.2046, 1e-4);
    EXPECT_NEAR(thin.opacity, 1 - std::exp(-1.0), 1e-6);
    const Material same = layer("<spectrum name=\"sigmaT\" value=\"2\"/><spectrum name=\"albedo\" "
                                "value=\"0.5\"/><float name=\"thickness\" value=\"0.5\"/>");
    EXPECT_EQ(same.albedo, thin.albedo);
    EXPECT_EQ(same.opacity, thin.opacity);
    const Material ketchup = layer("<string name=\"material\" value=\"Ketchup\"/>");
    EXPECT_GT(ketchup.albedo.x, 5 * ketchup.albedo.z);
}

TEST(MitsubaReplacedBsdfs, HairHasTheColorOfItsMelanin) {
    const auto hair = [](const std::string& inside) {
        const Found found = partsOf("<bsdf type=\"hair\">" + inside + "</bsdf>");
        EXPECT_THAT(found.forgiven, Contains(HasSubstr("a rough surface of its colour")));
        EXPECT_EQ(found.parts.size(), 1u);
        return found.parts.at(0).second.principled;
    };
    const PrincipledParameters brown = hair("");
    EXPECT_LT(brown.baseColor.x, 0.1f);
    EXPECT_GT(brown.baseColor.x, 2 * brown.baseColor.z);
    EXPECT_GT(hair("<float name=\"eumelanin\" value=\"0.1\"/>").baseColor.x, 0.2f);
    EXPECT_EQ(hair("<rgb name=\"sigma_a\" value=\"0 0 0\"/>").baseColor, glm::vec3(1));
    EXPECT_FLOAT_EQ(hair("<float name=\"longitudinal_roughness\" value=\"0.25\"/>").roughness,
                    0.5f);
}

TEST(MitsubaReplacedBsdfs, PolarizationFiltersLetLightThrough) {
    for (const auto& [type, kept] :
         {std::pair("polarizer", 0.25f), {"circular", 0.25f}, {"retarder", 0.5f}}) {
        const Found found = partsOf(fmt::format(
            "<bsdf type=\"{}\"><float name=\"transmittance\" value=\"0.5\"/></bsdf>", type));
        const Material& m = found.parts.at(0).second;
        EXPECT_EQ(m.albedo, glm::vec3(0));
        EXPECT_EQ(m.alphaMode, AlphaMode::Blend);
        EXPECT_EQ(m.opacity, 1 - kept) << type;
        EXPECT_THAT(found.forgiven, Contains(HasSubstr("lets as much light through")));
    }
}

TEST(MitsubaReplacedBsdfs, UnknownOnesShowTheirFirstColor) {
    const Found cloth = partsOf("<bsdf type=\"irawan\"><float name=\"repeatU\" value=\"5\"/>"
                                "<rgb name=\"kd\" value=\"0.5 0.25 0\"/><rgb name=\"ks\" "
                                "value=\"1\"/></bsdf>");
    expectNear(reflectedBy(cloth, MaterialKind::Diffuse), {0.5, 0.25, 0});
    const Found wrapped = partsOf("<bsdf type=\"polish\"><bsdf type=\"plastic\"/></bsdf>");
    EXPECT_EQ(wrapped.parts.at(0).second.kind, MaterialKind::Plastic);
    EXPECT_EQ(partsOf("<bsdf type=\"polish\"><texture type=\"checkerboard\"/></bsdf>")
                  .parts.at(0)
                  .second.textures.size(),
              1u);
}

TEST(MitsubaReplacedBsdfs, DefaultsAreThoseOfTheirTime) {
    const Material metal = partsOf("<bsdf type=\"roughconductor\"/>").parts.at(0).second;
    EXPECT_NEAR(metal.k.x, 3.912949 / 1.000277, 1e-5); // copper in air
    EXPECT_EQ(metal.facets.alpha, glm::vec2(0.1f));
    EXPECT_EQ(metal.facets.distribution, FacetDistribution::Beckmann);
    const Found phong = partsOf("<bsdf type=\"roughplastic\"><string name=\"distribution\" "
                                "value=\"phong\"/></bsdf>");
    EXPECT_EQ(phong.parts.at(0).second.facets.distribution, FacetDistribution::Beckmann);
    EXPECT_THAT(phong.forgiven, Contains(HasSubstr("'distribution' is 'phong'")));
    EXPECT_EQ(partsOf("<bsdf type=\"bump\"><texture type=\"checkerboard\"/><bsdf "
                      "type=\"diffuse\"/></bsdf>")
                  .parts.at(0)
                  .second.textures.at(0)
                  .slot,
              TextureSlot::Height);
}

} // namespace
} // namespace stromboli::test
