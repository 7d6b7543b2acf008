// What surfaces are made of.

#include "scene/build/texels.hpp"
#include "scene/model/surface_lookup.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

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

TEST(MitsubaBsdfs, BacksAreBlackUnlessTheyAreTwoSided) {
    for (const char* type : {"diffuse", "conductor", "roughconductor", "plastic", "principled"}) {
        const std::string bsdf = fmt::format("<bsdf type=\"{}\"/>", type);
        EXPECT_TRUE(materialOf(bsdf).isBlackBehind) << type;
        EXPECT_FALSE(materialOf("<bsdf type=\"twosided\">" + bsdf + "</bsdf>").isBlackBehind)
            << type;
    }
    EXPECT_TRUE(materialOf("").isBlackBehind);
    const auto isOldBlack = [](const std::string& before) {
        return loadText(sceneText(before + rectangleOf("<bsdf type=\"diffuse\"/>"), "0.5.0"))
            .materials.at(0)
            .isBlackBehind;
    };
    EXPECT_TRUE(isOldBlack(""));
    EXPECT_FALSE(isOldBlack("<mode type=\"final\"/>")); // of another renderer
    for (const char* type : {"dielectric", "thindielectric", "roughdielectric", "principledthin"})
        EXPECT_FALSE(materialOf(fmt::format("<bsdf type=\"{}\"/>", type)).isBlackBehind) << type;
    EXPECT_FALSE(
        materialOf("<bsdf type=\"principled\"><float name=\"spec_trans\" value=\"0.5\"/></bsdf>")
            .isBlackBehind);
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
                AllOf(HasSubstr("is 'Xy', expected one of none, Ag, Al, Au, Cu, a-C"),
                      HasSubstr("W, or eta and k")));
}

/// Alpha along the tangent is in green, and across it in blue.
TEST(MitsubaBsdfs, RoughnessMayBeATexture) {
    const auto board = [](const std::string& name, const std::string& low) {
        return "<texture name=\"" + name +
               "\" type=\"checkerboard\"><float name=\"color0\" value=\"" + low +
               "\"/><float name=\"color1\" value=\"0.5\"/></texture>";
    };
    for (const char* type : {"roughconductor", "roughdielectric"}) {
        const auto roughSceneOf = [&](const std::string& inside) {
            return sceneOf(fmt::format("<bsdf type=\"{}\">{}</bsdf>", type, inside));
        };
        const auto usesOf = [](const Scene& scene) {
            return scene.materials.at(scene.triangles.at(0).material).textures;
        };
        const auto texelsOf = [&](const Scene& scene, size_t use) {
            const TextureImage& image =
                scene.images.at(scene.textures.at(usesOf(scene).at(use).texture).image);
            std::set<std::pair<float, float>> texels; // of green and blue
            for (size_t i = 0; i < size_t(image.width) * image.height; ++i) {
                const glm::dvec3 c = build::colorAt(image, i, false);
                texels.emplace(float(c.y), float(c.z));
            }
            return texels;
        };
        const Scene both = roughSceneOf(board("alpha", "0.25"));
        EXPECT_TRUE(both.report.warnings.empty());
        ASSERT_EQ(usesOf(both).size(), 1u);
        EXPECT_EQ(usesOf(both)[0].slot, TextureSlot::MetallicRoughness);
        using Texels = std::set<std::pair<float, float>>;
        EXPECT_EQ(texelsOf(both, 0), (Texels{{0.25f, 0.25f}, {0.5f, 0.5f}}));
        const Scene apart = roughSceneOf(board("alpha_u", "0.25") + board("alpha_v", "0.125"));
        ASSERT_EQ(usesOf(apart).size(), 2u);
        EXPECT_EQ(texelsOf(apart, 0), (Texels{{0.25f, 1}, {0.5f, 1}}));
        EXPECT_EQ(texelsOf(apart, 1), (Texels{{1, 0.125f}, {1, 0.5f}}));
    }
}

TEST(MitsubaBsdfs, Plastics) {
    const Material plastic = materialOf("<bsdf type=\"roughplastic\"><boolean name=\"nonlinear\" "
                                        "value=\"true\"/></bsdf>");
    EXPECT_EQ(plastic.kind, MaterialKind::Plastic);
    EXPECT_TRUE(plastic.isNonlinear);
    EXPECT_FLOAT_EQ(plastic.ior, 1.49f / 1.000277f);
    EXPECT_EQ(plastic.facets.alpha.x, 0.1f);
    EXPECT_EQ(plastic.facets.masking, FacetMasking::Separable);
    EXPECT_EQ(plastic.internalViews, 64u);
    const Material polarizing =
        materialOf("<bsdf type=\"pplastic\"><float name=\"alpha\" value=\"0.3\"/></bsdf>");
    EXPECT_EQ(polarizing.kind, MaterialKind::Plastic);
    EXPECT_EQ(polarizing.facets.alpha, glm::vec2(0.3f));
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
    EXPECT_THAT(problem(board + "<texture type=\"checkerboard\"/><bsdf type=\"diffuse\"/>"),
                HasSubstr("is the second texture of this bsdf"));
    EXPECT_THAT(
        problem(board + "<bsdf type=\"bumpmap\">" + board + "<bsdf type=\"diffuse\"/></bsdf>"),
        HasSubstr("is a bump map over another map of normals"));
}

/// Burley's index of a specular of 0.5 has 4 % at normal incidence: 1.5.
TEST(MitsubaBsdfs, PrincipledIsBurleys) {
    const Material m = materialOf("<bsdf type=\"principled\"><float name=\"metallic\" value=\"1\"/>"
                                  "<float name=\"sheen\" value=\"0.75\"/></bsdf>");
    EXPECT_EQ(m.kind, MaterialKind::Burley);
    EXPECT_EQ(m.burley.metallic, 1);
    EXPECT_EQ(m.burley.sheen, 0.75f);
    EXPECT_FLOAT_EQ(m.burley.ior, 1.5f);
    EXPECT_FALSE(m.burley.isThin);
}

TEST(MitsubaBsdfs, BlendsAreMixtures) {
    const std::string two = "<bsdf type=\"diffuse\"/><bsdf type=\"conductor\"/>";
    const Scene scene = sceneOf("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.25\"/>" +
                                two + "</bsdf>");
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(m.kind, MaterialKind::Diffuse);
    EXPECT_EQ(m.otherShare, 0.25f);
    EXPECT_EQ(scene.materials.at(m.other).kind, MaterialKind::Conductor);
    EXPECT_TRUE(scene.materials.at(m.other).isBlackBehind);
    const Scene both =
        sceneOf("<bsdf type=\"twosided\"><bsdf type=\"blendbsdf\">" + two + "</bsdf></bsdf>");
    const Material& n = both.materials.at(both.triangles.at(0).material);
    EXPECT_EQ(n.otherShare, 0.5f);
    EXPECT_FALSE(n.isBlackBehind || both.materials.at(n.other).isBlackBehind);
    EXPECT_THAT(
        problemInside(rectangleOf("<bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/></bsdf>")),
        HasSubstr("has 1 bsdfs inside, expected two"));
}

/// What takes the place may be a mixture; a first one that is is what takes the place.
TEST(MitsubaBsdfs, BlendsMayBeOfBlends) {
    const std::string blend =
        "<bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/><bsdf type=\"conductor\"/></bsdf>";
    const Scene scene = sceneOf("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.25\"/>" +
                                blend + "<bsdf type=\"plastic\"/></bsdf>");
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(m.kind, MaterialKind::Plastic);
    EXPECT_EQ(m.otherShare, 0.75f);
    const Material& other = scene.materials.at(m.other);
    EXPECT_EQ(other.kind, MaterialKind::Diffuse);
    EXPECT_EQ(scene.materials.at(other.other).kind, MaterialKind::Conductor);
}

/// Numbers of one slot may come from two pictures, each of which is 1 where the other one has its
/// number.
TEST(MitsubaBsdfs, PrincipledTakesPicturesOfAnyNumber) {
    const auto board = [](const char* name) {
        return fmt::format("<texture type=\"checkerboard\" name=\"{}\"><float name=\"color1\" "
                           "value=\"0.25\"/></texture>",
                           name);
    };
    const Scene scene =
        sceneOf("<bsdf type=\"principled\">" + board("roughness") + board("metallic") + "</bsdf>");
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    ASSERT_EQ(m.textures.size(), 2u);
    EXPECT_EQ(m.burley.roughness, 1);
    for (const TextureUse& use : m.textures) {
        EXPECT_EQ(use.slot, TextureSlot::MetallicRoughness);
        const glm::dvec4 texel =
            texelAt(scene.images[scene.textures[use.texture].image], false, 0, 0);
        EXPECT_EQ(texel.x, 1);
        EXPECT_EQ(texel.y * texel.z, 0.25); // of numbers, color1 is the first
    }
}

TEST(MitsubaBsdfs, PrincipledThinTransmitsDiffuselyFromZeroToTwo) {
    const Material m = materialOf("<bsdf type=\"principledthin\"><float name=\"diff_trans\" "
                                  "value=\"1.5\"/></bsdf>");
    EXPECT_TRUE(m.burley.isThin);
    EXPECT_EQ(m.burley.diffuseTransmission, 0.75f);
    EXPECT_EQ(m.burley.ior, 1.5f);
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
    const auto opacity = [&](size_t i) { return glm::unpackHalf2x16(image.words[2 * i]).x; };
    EXPECT_NEAR(opacity(1), 1, 1e-3); // of numbers, color1 is the first
    EXPECT_EQ(opacity(0), 0);
}

const std::string kPicture = "<texture name=\"@\" type=\"checkerboard\"/>";

std::string pictureOf(const std::string& name) {
    std::string text = kPicture;
    return text.replace(text.find('@'), 1, name);
}

/// Leaves: a coloured picture, and another one of where they are.
TEST(MitsubaBsdfs, MasksMayBeOverPictures) {
    const Scene scene =
        sceneOf("<bsdf type=\"mask\">" + pictureOf("opacity") + "<bsdf type=\"diffuse\">" +
                pictureOf("reflectance") + "</bsdf></bsdf>");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.alphaMode, AlphaMode::Blend);
    EXPECT_EQ(m.opacity, 1);
    ASSERT_EQ(m.textures.size(), 2u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::BaseColor);
    EXPECT_EQ(m.textures[1].slot, TextureSlot::Opacity);
    EXPECT_GT(m.textures[1].scale, 0);
}

/// A blend with nothing is a mask, of the weight or of what it leaves.
TEST(MitsubaBsdfs, BlendsWithNothingAreMasks) {
    const std::string nothing = "<bsdf type=\"null\"/>", paint = "<bsdf type=\"diffuse\"/>";
    const auto blend = [](const std::string& inside) {
        return materialOf("<bsdf type=\"blendbsdf\">" + inside + "</bsdf>");
    };
    const Material second = blend(pictureOf("weight") + nothing + paint);
    EXPECT_EQ(second.other, kNoMaterial);
    ASSERT_EQ(second.textures.size(), 1u);
    EXPECT_EQ(second.textures[0].slot, TextureSlot::Opacity);
    EXPECT_GT(second.textures[0].scale, 0);
    const Material first = blend(pictureOf("weight") + paint + nothing);
    EXPECT_LT(first.textures.at(0).scale, 0);
    EXPECT_EQ(first.alphaMode, AlphaMode::Blend);
    const std::string weight = "<float name=\"weight\" value=\"0.25\"/>";
    EXPECT_EQ(blend(weight + nothing + paint).opacity, 0.25f);
    EXPECT_EQ(blend(weight + paint + nothing).opacity, 0.75f);
}

TEST(MitsubaBsdfs, BacksMayDiffer) {
    const std::string paint = "<bsdf type=\"diffuse\"/>", metal = "<bsdf type=\"conductor\"/>";
    const auto twoSided = [](const std::string& inside) {
        return sceneOf("<bsdf type=\"twosided\">" + inside + "</bsdf>");
    };
    const auto first = [](const Scene& scene) {
        return scene.materials.at(scene.triangles.at(0).material);
    };
    const Scene scene = twoSided(paint + metal);
    const Material front = first(scene), back = scene.materials.at(front.other);
    EXPECT_EQ(front.kind, MaterialKind::Diffuse);
    EXPECT_EQ(front.otherPlace, OtherPlace::Behind);
    EXPECT_EQ(front.otherShare, 1);
    EXPECT_EQ(back.kind, MaterialKind::Conductor);
    EXPECT_FALSE(front.isBlackBehind || back.isBlackBehind);

    const std::string blend = "<bsdf type=\"blendbsdf\">" + paint + metal + "</bsdf>";
    const Scene mixed = twoSided(blend + "<bsdf type=\"plastic\"/>");
    EXPECT_EQ(first(mixed).kind, MaterialKind::Plastic);
    EXPECT_EQ(first(mixed).otherPlace, OtherPlace::InFront);
    EXPECT_EQ(mixed.materials.at(first(mixed).other).otherShare, 0.5f);

    const auto problem = [](const std::string& inside) {
        return problemInside(rectangleOf("<bsdf type=\"twosided\">" + inside + "</bsdf>"));
    };
    EXPECT_THAT(problem(blend + blend), HasSubstr("has two bsdfs that are blends"));
    EXPECT_THAT(problem("<bsdf type=\"mask\">" + paint + "</bsdf>" + metal),
                HasSubstr("expected the mask around the two-sided bsdf"));
    EXPECT_THAT(problem(paint + metal + paint), HasSubstr("has 3 bsdfs inside"));
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
                HasSubstr("2: <bsdf>: 'velvet' is no bsdf that is read, and states no colour"));
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" "
                                          "type=\"noise\"/></bsdf>")),
                HasSubstr("'noise' is no texture that is read"));
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"diffuse\"><rgb name=\"color\" "
                                          "value=\"1\"/></bsdf>")),
                HasSubstr("'color' is not read in bsdf 'diffuse'; expected one of reflectance"));
}

/// A, there in half of all cases, and B in the other place of a quarter: 7/8 of 3/4 is there.
TEST(MitsubaBsdfs, MasksInBlendsAreTakenOut) {
    const std::string weight = "<float name=\"weight\" value=\"0.25\"/>";
    const std::string masked = "<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/>"
                               "<bsdf type=\"diffuse\"/></bsdf>";
    const std::string metal = "<bsdf type=\"conductor\"/>";
    const auto firstOf = [](const std::string& inside) {
        const Scene scene = sceneOf("<bsdf type=\"blendbsdf\">" + inside + "</bsdf>");
        return scene.materials.at(scene.triangles.at(0).material);
    };
    const Material first = firstOf(weight + masked + metal);
    EXPECT_EQ(first.alphaMode, AlphaMode::Blend);
    EXPECT_NEAR(first.opacity, 0.75 * 0.5 + 0.25, 1e-6);
    EXPECT_NEAR(first.otherShare, 0.25 / 0.625, 1e-6);
    const Material second = firstOf(weight + metal + masked);
    EXPECT_NEAR(second.opacity, 0.75 + 0.25 * 0.5, 1e-6);
    EXPECT_NEAR(second.otherShare, 0.125 / 0.875, 1e-6);
    // As a sheet with holes: what is not there is a bsdf like any other.
    const Material holes = firstOf(weight + metal + "<bsdf type=\"null\"/>");
    EXPECT_NEAR(holes.opacity, 0.75, 1e-6);
    EXPECT_EQ(holes.otherShare, 0);
    // The first one a blend: both change places.
    const Material nested = firstOf(weight + "<bsdf type=\"blendbsdf\">" + metal +
                                    "<bsdf type=\"plastic\"/></bsdf>" + masked);
    EXPECT_NEAR(nested.opacity, 0.75 + 0.25 * 0.5, 1e-6);
    EXPECT_NEAR(nested.otherShare, 0.75 / 0.875, 1e-6);
    EXPECT_THAT(problemInside(rectangleOf(
                    "<bsdf type=\"blendbsdf\"><texture name=\"weight\" type=\"checkerboard\"/>" +
                    metal + masked + "</bsdf>")),
                HasSubstr("has a mask inside, and a weight or an opacity that is a texture"));
}

TEST(MitsubaBsdfs, MasksInMasksMultiply) {
    const Material m =
        materialOf("<bsdf type=\"mask\"><float name=\"opacity\" value=\"0.5\"/><bsdf "
                   "type=\"mask\"><float name=\"opacity\" value=\"0.25\"/><bsdf "
                   "type=\"diffuse\"/></bsdf></bsdf>");
    EXPECT_EQ(m.opacity, 0.125f);
}

} // namespace
} // namespace stromboli::test
