#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Scene loadEffect(const std::string& effect, bool cs184 = false) {
    DocumentText document;
    document.libraries =
        "<library_effects><effect id=\"e\">" + effect +
        "</effect></library_effects><library_materials><material id=\"m\" name=\"Mat\">"
        "<instance_effect url=\"#e\"/></material></library_materials>" +
        meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                    fmt::format("<triangles material=\"M\" count=\"1\">{}<p>0 1 2</p></triangles>",
                                kVertexInput));
    document.nodes = "<node><instance_geometry url=\"#mesh\"><bind_material><technique_common>"
                     "<instance_material symbol=\"M\" target=\"#m\"/></technique_common>"
                     "</bind_material></instance_geometry></node>";
    return load(document, cs184);
}

std::string profile(const std::string& model, const std::string& before = "") {
    return "<profile_COMMON>" + before + "<technique sid=\"common\">" + model +
           "</technique></profile_COMMON>";
}

std::string dialect(const std::string& content, const char* name = "CGL") {
    return fmt::format("<extra><technique profile=\"{}\">{}</technique></extra>", name, content);
}

Material common(const std::string& model, const std::string& before = "") {
    return loadEffect(profile(model, before)).materials.at(0);
}

Material cgl(const std::string& content) {
    return loadEffect(profile("<phong/>") + dialect(content)).materials.at(0);
}

const char* const kDiffuse = "<diffuse><color>0.1 0.2 0.3 1</color></diffuse>";
const char* const kEmission = "<emission><color>4 5 6 1</color></emission>";

TEST(Effects, ShadingModels) {
    for (const char* model : {"lambert", "phong", "blinn"}) {
        const Material material =
            common(fmt::format("<{0}>{1}{2}</{0}>", model, kEmission, kDiffuse));
        EXPECT_EQ(material.kind, MaterialKind::Diffuse);
        EXPECT_EQ(material.name, "Mat");
        EXPECT_EQ(material.albedo, glm::vec3(0.1f, 0.2f, 0.3f));
        EXPECT_EQ(material.emission, glm::vec3(4, 5, 6));
        EXPECT_TRUE(material.emitsBothSides);
    }
    const Material constant = common(fmt::format("<constant>{}</constant>", kEmission));
    EXPECT_EQ(constant.albedo, glm::vec3(0));
    EXPECT_EQ(constant.emission, glm::vec3(4, 5, 6));
    EXPECT_EQ(common("<lambert/>").albedo, glm::vec3(0)) << "what is absent reflects nothing";
}

TEST(Effects, Parameters) {
    const std::string model = "<phong><diffuse><param ref=\"d\"/></diffuse></phong>";
    const std::string newparam = "<newparam sid=\"d\"><float4>0.1 0.2 0.3 1</float4></newparam>";
    EXPECT_EQ(common(model, newparam).albedo, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(loadEffect(newparam + profile(model)).materials.at(0).albedo,
              glm::vec3(0.1f, 0.2f, 0.3f));
}

TEST(Effects, TexturesWithoutSamplersBecomeGrey) {
    const char* const texture = "<texture texture=\"t\" texcoord=\"UV\"/>";
    const Scene scene = loadEffect(profile(
        fmt::format("<phong><emission>{0}</emission><diffuse>{0}</diffuse></phong>", texture)));
    EXPECT_EQ(scene.materials[0].albedo, glm::vec3(0.5f));
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(0));
    EXPECT_THAT(scene.report.forgiven,
                ElementsAre(HasSubstr("mid grey"), HasSubstr("does not emit")));
}

TEST(Effects, WhatIsNotRenderedIsReported) {
    const auto ignored = [](const std::string& content) {
        return loadEffect(profile("<phong>" + content + "</phong>")).report.ignored;
    };
    EXPECT_THAT(ignored("<specular><color>0 0 0.1 1</color></specular>"),
                ElementsAre(HasSubstr("1 <specular>")));
    EXPECT_THAT(ignored("<specular><color>0 0 0 1</color></specular>"), IsEmpty());
    EXPECT_THAT(ignored("<shininess><float>50</float></shininess>"), IsEmpty());
    EXPECT_THAT(ignored("<reflective><color>1 1 1 1</color></reflective>"),
                ElementsAre(HasSubstr("1 <reflective>")));
    EXPECT_THAT(ignored("<reflective><color>1 1 1 1</color></reflective>"
                        "<reflectivity><float>0</float></reflectivity>"),
                IsEmpty());
    EXPECT_THAT(ignored("<ambient><color>1 1 1 1</color></ambient>"),
                ElementsAre(HasSubstr("1 <ambient>")));
}

TEST(Effects, TransparencyIsReadInAllItsModes) {
    const auto opacity = [](const char* mode, const char* color, const char* factor) {
        const std::string content =
            fmt::format("<phong><transparent{}><color>{}</color></transparent><transparency><float>"
                        "{}</float></transparency></phong>",
                        *mode ? fmt::format(" opaque=\"{}\"", mode) : "", color, factor);
        const Material material = loadEffect(profile(content)).materials.at(0);
        return material.alphaMode == AlphaMode::Opaque ? 1.0f : material.opacity;
    };
    EXPECT_EQ(opacity("", "1 1 1 1", "1"), 1);
    EXPECT_EQ(opacity("", "1 1 1 1", "0.5"), 0.5f);
    EXPECT_EQ(opacity("A_ONE", "1 1 1 0", "1"), 0);
    EXPECT_EQ(opacity("A_ZERO", "1 1 1 1", "0"), 1);
    EXPECT_EQ(opacity("A_ZERO", "1 1 1 1", "0.25"), 0.75f);
    EXPECT_EQ(opacity("RGB_ZERO", "0 0 0 1", "1"), 1);
    // The standard's luminance of green, and of all but blue.
    EXPECT_FLOAT_EQ(opacity("RGB_ZERO", "0 1 0 1", "1"), 1 - 0.715160f);
    EXPECT_EQ(opacity("RGB_ONE", "1 1 1 0", "1"), 1);
    EXPECT_FLOAT_EQ(opacity("RGB_ONE", "1 1 0 1", "1"), 1 - 0.072169f);
}

TEST(Effects, AlbedoIsClamped) {
    const Scene scene =
        loadEffect(profile("<phong><diffuse><color>-1 0.5 2 1</color></diffuse></phong>"));
    EXPECT_EQ(scene.materials[0].albedo, glm::vec3(0, 0.5f, 1));
    EXPECT_THAT(scene.report.warnings, ElementsAre(HasSubstr("clamped")));
}

TEST(Effects, DialectMaterials) {
    const Material emission = cgl("<emission><radiance>10 9 8</radiance></emission>");
    EXPECT_EQ(emission.kind, MaterialKind::Diffuse);
    EXPECT_EQ(emission.albedo, glm::vec3(0));
    EXPECT_EQ(emission.emission, glm::vec3(10, 9, 8));
    const Material mirror = cgl("<mirror><reflectance>1 0.8 0.4</reflectance></mirror>");
    EXPECT_EQ(mirror.kind, MaterialKind::Mirror);
    EXPECT_EQ(mirror.reflectance, glm::vec3(1, 0.8f, 0.4f));
    const Material refraction =
        cgl("<refraction><transmittance>1 1 0</transmittance><ior>1.45</ior></refraction>");
    EXPECT_EQ(refraction.kind, MaterialKind::Refraction);
    EXPECT_EQ(refraction.transmittance, glm::vec3(1, 1, 0));
    EXPECT_EQ(refraction.ior, 1.45f);
    const Material glass = cgl("<glass><reflectance>1 1 0</reflectance><transmittance>0 1 1"
                               "</transmittance><roughness>0</roughness><ior>1.6</ior></glass>");
    EXPECT_EQ(glass.kind, MaterialKind::Dielectric);
    EXPECT_EQ(glass.reflectance, glm::vec3(1, 1, 0));
    EXPECT_EQ(glass.transmittance, glm::vec3(0, 1, 1));
    EXPECT_EQ(glass.ior, 1.6f);
    const Material metal =
        cgl("<microfacet><alpha>0.25</alpha><eta>1 2 3</eta><k>4 5 6</k></microfacet>");
    EXPECT_EQ(metal.kind, MaterialKind::Conductor);
    EXPECT_EQ(metal.facets.alpha, glm::vec2(0.25f));
    EXPECT_EQ(metal.facets.distribution, FacetDistribution::Beckmann);
    EXPECT_EQ(metal.eta, glm::vec3(1, 2, 3));
    EXPECT_EQ(metal.k, glm::vec3(4, 5, 6));
    EXPECT_EQ(cgl("<diffuse><reflectance>0.3 0.3 0.3</reflectance></diffuse>").albedo,
              glm::vec3(0.3f));
}

TEST(Effects, TheLastDialectMaterialWins) {
    const std::string two = "<mirror><reflectance>1 1 1</reflectance></mirror>"
                            "<emission><radiance>2 2 2</radiance></emission>";
    EXPECT_EQ(cgl(two).kind, MaterialKind::Diffuse);
    for (const char* name : {"CGL", "CMU462"}) {
        const Scene scene = loadEffect(dialect(two, name));
        EXPECT_EQ(scene.materials[0].emission, glm::vec3(2));
        EXPECT_TRUE(scene.cglDialect);
    }
}

TEST(Effects, UnsupportedDialectMaterialsUseTheCommonProfile) {
    const Scene scene =
        loadEffect(profile(fmt::format("<phong>{}</phong>", kDiffuse)) + dialect("<glossy/>"));
    EXPECT_EQ(scene.materials[0].albedo, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("1 <glossy>")));
}

TEST(Effects, AsTheCs184RendererReadsThem) {
    const auto material = [](const std::string& model) {
        return loadEffect(profile(model), true).materials.at(0);
    };
    const Material phong = material(fmt::format("<phong>{}{}</phong>", kEmission, kDiffuse));
    EXPECT_EQ(phong.albedo, glm::vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(phong.emission, glm::vec3(0));
    EXPECT_EQ(material("<phong/>").albedo, glm::vec3(0.5f));
    EXPECT_EQ(material(fmt::format("<lambert>{}</lambert>", kDiffuse)).albedo, glm::vec3(0.5f));
}

TEST(Effects, BadOnesAreErrors) {
    for (const char* bad :
         {"<mirror/>", "<glass><reflectance>1 1 1</reflectance></glass>",
          "<refraction><transmittance>1 1 1</transmittance><ior>0</ior></refraction>",
          "<microfacet><alpha>-1</alpha><eta>1 1 1</eta><k>1 1 1</k></microfacet>",
          "<emission><radiance>bright</radiance></emission>"})
        EXPECT_THROW(cgl(bad), SceneError) << bad;
    EXPECT_THROW(common("<phong><diffuse><color>1</color></diffuse></phong>"), SceneError);
    const Scene foreign = loadEffect("<profile_GLSL/>");
    EXPECT_EQ(foreign.materials[0].albedo, glm::vec3(0.5f));
    EXPECT_THAT(foreign.report.warnings, Contains(HasSubstr("no <profile_COMMON>")));
}

} // namespace
} // namespace stromboli::test
