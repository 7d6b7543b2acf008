// What files of Mitsuba 0.x call by other names than later ones, and mean otherwise.

#include "scene/build/spectrum.hpp"
#include "scene/mitsuba/color_text.hpp"
#include "scene/model/srgb.hpp"
#include "scene/model/surface_lookup.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>
#include <glm/trigonometric.hpp>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Material oldMaterial(const std::string& bsdf) {
    const Scene scene = loadOld(rectangleOf(bsdf));
    return scene.materials.at(scene.triangles.at(0).material);
}

glm::vec3 oldReflectance(const std::string& color) {
    return oldMaterial("<bsdf type=\"diffuse\">" + color + "</bsdf>").albedo;
}

/// Red is 255 and 128, green 0, blue as the column says.
std::string twoTexels() {
    return writePicture("two.tga", 2, 1, {{255, 0, 64, 255}, {128, 0, 64, 51}});
}

std::string bitmap(const std::string& name, const std::string& inside) {
    return "<texture type=\"bitmap\" name=\"" + name + "\"><string name=\"filename\" value=\"" +
           twoTexels() + "\"/>" + inside + "</texture>";
}

TEST(MitsubaOldFiles, ObjectsInsideHaveOldNamesToo) {
    const Material m =
        oldMaterial("<bsdf type=\"roughplastic\">" + bitmap("diffuseReflectance", "") + "</bsdf>");
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::BaseColor);
    const Scene named =
        loadOld("<texture id=\"board\" type=\"checkerboard\"/>" +
                rectangleOf("<bsdf type=\"plastic\">"
                            "<ref name=\"diffuseReflectance\" id=\"board\"/></bsdf>"));
    EXPECT_EQ(named.materials.at(0).textures.size(), 1u);
    EXPECT_THAT(named.report.forgiven, IsEmpty());
}

TEST(MitsubaOldFiles, ColorsAreStatedInManyWays) {
    EXPECT_EQ(oldReflectance("<srgb name=\"reflectance\" value=\"#ff0080\"/>"),
              glm::vec3(1, 0, srgbToLinear(128 / 255.0)));
    EXPECT_EQ(oldReflectance("<srgb name=\"reflectance\" value=\"0.5 0 1\"/>"),
              glm::vec3(srgbToLinear(0.5), 0, 1));
    // As Mitsuba 0.x has it, <rgb> does not decode what it is given.
    EXPECT_EQ(oldReflectance("<rgb name=\"reflectance\" value=\"#ff0080\"/>"),
              glm::vec3(1, 0, 128 / 255.0));
    EXPECT_EQ(oldReflectance("<spectrum name=\"reflectance\" value=\"0.25, 0.5, 0.75\"/>"),
              glm::vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(
        oldReflectance("<spectrum name=\"reflectance\" value=\"0.25\" intent=\"reflectance\"/>"),
        glm::vec3(0.25f));
    EXPECT_THAT(problemInside(rectangleOf("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" "
                                          "value=\"#ff0080\"/></bsdf>")),
                HasSubstr("<srgb> takes #rrggbb"));
}

TEST(MitsubaOldFiles, SpectraAreInFiles) {
    writeFile("green.spd", "# nanometres, value\n400 0\n\n500 1\n600  1\n700 0 and more\n");
    const glm::vec3 fromFile =
        oldReflectance("<spectrum name=\"reflectance\" filename=\"green.spd\"/>");
    EXPECT_EQ(fromFile, oldReflectance("<spectrum name=\"reflectance\" "
                                       "value=\"600:1, 700:0, 400:0, 500:1\"/>")); // in any order
    EXPECT_GT(fromFile.y, fromFile.z);
    writeFile("empty.spd", "# nothing\n");
    EXPECT_THAT(problemInOld(rectangleOf("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" "
                                         "filename=\"empty.spd\"/></bsdf>")),
                HasSubstr("has 0 wavelengths, expected two or more"));
}

/// Wien: at 6504 K the light is nearly that of D65, far below that it is red; Planck at 555 nm.
TEST(MitsubaOldFiles, BlackBodiesShineAsPlanckSays) {
    const auto light = [](const std::string& temperature, const std::string& scale) {
        return loadOld("<emitter type=\"point\"><blackbody name=\"intensity\" temperature=\"" +
                       temperature + "\" scale=\"" + scale + "\"/></emitter>")
            .lights.at(0)
            .color;
    };
    const glm::vec3 day = light("6504K", "1"), dusk = light("2000 K", "1");
    EXPECT_NEAR(day.x / day.y, 1, 0.08); // a little less green than daylight
    EXPECT_NEAR(day.z / day.y, 1, 0.08);
    EXPECT_GT(dusk.x, 3 * dusk.y);
    EXPECT_NEAR(light("6504", "0.25").y / day.y, 0.25, 1e-6);
    // 2 h c^2 / l^5 / (exp(h c / l k T) - 1) at 555 nm and 5000 K, per nanometre.
    const auto samples = mitsuba::blackbodyOf(5000, 1).samples;
    EXPECT_NEAR(samples.at(39).second, 12763, 40);
    EXPECT_EQ(samples.at(39).first, 555);
}

/// In RGB builds of Mitsuba 0.x a spectrum that is alike everywhere is D65.
TEST(MitsubaOldFiles, SpectraOfLightAreWhite) {
    const std::string lamp = "<emitter type=\"point\"><spectrum name=\"intensity\" "
                             "value=\"2\"/></emitter>";
    EXPECT_EQ(loadOld(lamp).lights.at(0).color, glm::vec3(2));
}

TEST(MitsubaOldFiles, IntegratorsThatTracePathsOtherwiseArePath) {
    for (const char* type : {"sppm", "bdpt", "pssmlt", "mlt", "erpt", "ptracer", "photonmapper",
                             "ppm", "vpl", "volpath_simple", "volpath"}) {
        const Scene scene =
            loadOld(fmt::format("<integrator type=\"{}\"><integer name=\"maxDepth\" "
                                "value=\"6\"/></integrator>",
                                type));
        EXPECT_EQ(scene.hints.maxBounces, 5u) << type;
        const bool isSaid = std::string(type).find("volpath") == std::string::npos;
        EXPECT_EQ(scene.report.assumed.size(), isSaid ? 1u : 0u) << type;
    }
    const Scene inside =
        loadOld("<integrator type=\"irrcache\"><integrator type=\"adaptive\">"
                "<integrator type=\"path\"><integer name=\"maxDepth\" value=\"3\"/>"
                "</integrator></integrator></integrator>");
    EXPECT_EQ(inside.hints.maxBounces, 2u);
    EXPECT_THAT(inside.report.assumed, Contains(HasSubstr("'irrcache': the one inside it")));
}

TEST(MitsubaOldFiles, MitchellsFilterHasItsNumbers) {
    const RenderHints hints =
        loadOld("<sensor type=\"perspective\"><film type=\"ldrfilm\"><rfilter type=\"mitchell\">"
                "<float name=\"B\" value=\"0.25\"/><float name=\"C\" value=\"0.5\"/></rfilter>"
                "</film></sensor>")
            .hints;
    EXPECT_EQ(hints.filter, HintedFilter::Mitchell);
    EXPECT_EQ(hints.filterShape.b, 0.25);
    EXPECT_EQ(hints.filterShape.c, 0.5);
}

TEST(MitsubaOldFiles, TexturesAreScaledAndThenMoved) {
    const Material m =
        oldMaterial("<bsdf type=\"diffuse\">" +
                    bitmap("reflectance", "<float name=\"uscale\" value=\"2\"/>"
                                          "<float name=\"vscale\" value=\"4\"/>"
                                          "<float name=\"uoffset\" value=\"0.5\"/>"
                                          "<float name=\"voffset\" value=\"0.25\"/>") +
                    "</bsdf>");
    EXPECT_EQ(m.textures.at(0).uRow, glm::vec3(2, 0, 0.5f));
    EXPECT_EQ(m.textures.at(0).vRow, glm::vec3(0, 4, 0.25f));
}

TEST(MitsubaOldFiles, TexturesWrapEachAxisByItself) {
    const Scene scene = loadOld(
        rectangleOf("<bsdf type=\"diffuse\">" +
                    bitmap("reflectance", "<string name=\"wrapModeV\" value=\"clamp\"/>"
                                          "<string name=\"wrapMode\" value=\"mirror\"/>"
                                          "<string name=\"filterType\" value=\"trilinear\"/>"
                                          "<float name=\"maxAnisotropy\" value=\"4\"/>") +
                    "</bsdf>"));
    EXPECT_EQ(scene.textures.at(0).wrapU, Wrap::Mirror);
    EXPECT_EQ(scene.textures.at(0).wrapV, Wrap::Clamp);
    EXPECT_FALSE(scene.textures.at(0).nearest);
    EXPECT_TRUE(scene.textures.at(0).srgb);
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
    const auto filtered = [](const char* filter) {
        return loadOld(rectangleOf("<bsdf type=\"diffuse\">" +
                                   bitmap("reflectance", fmt::format("<string name=\"filterType\" "
                                                                     "value=\"{}\"/>",
                                                                     filter)) +
                                   "</bsdf>"))
            .textures.at(0)
            .nearest;
    };
    EXPECT_FALSE(filtered("ewa"));
    EXPECT_TRUE(filtered("nearest"));
}

TEST(MitsubaOldFiles, PicturesHaveAGammaAndChannels) {
    const auto image = [](const std::string& inside) {
        const Scene scene = loadOld(
            rectangleOf("<bsdf type=\"diffuse\">" + bitmap("reflectance", inside) + "</bsdf>"));
        EXPECT_THAT(scene.report.forgiven, IsEmpty());
        return std::pair(scene.textures.at(0), scene.images.at(0).words.at(1));
    };
    const auto [usual, texel] = image("");
    EXPECT_TRUE(usual.srgb);
    EXPECT_EQ(texel, 0xFF400080u);
    EXPECT_FALSE(image("<float name=\"gamma\" value=\"1\"/>").first.srgb);
    EXPECT_TRUE(image("<float name=\"gamma\" value=\"-1\"/>").first.srgb);
    EXPECT_EQ(image("<string name=\"channel\" value=\"r\"/>").second, 0xFF808080u);
    EXPECT_EQ(image("<string name=\"channel\" value=\"b\"/>").second, 0xFF404040u);
    const auto [alpha, covered] = image("<string name=\"channel\" value=\"a\"/>");
    EXPECT_EQ(covered, 0xFF333333u);
    EXPECT_FALSE(alpha.srgb);
}

/// A mask by the alpha of a picture.
TEST(MitsubaOldFiles, MasksTakeAChannel) {
    const Scene scene =
        loadOld(rectangleOf("<bsdf type=\"mask\">" +
                            bitmap("opacity", "<string name=\"channel\" value=\"a\"/>"
                                              "<string name=\"filterType\" value=\"nearest\"/>") +
                            "<bsdf type=\"diffuse\"/></bsdf>"));
    const Material& m = scene.materials.at(0);
    EXPECT_NEAR(lookUp(scene, m.textures.at(0), {{glm::dvec2(0.75, 0.5), glm::dvec2(0)}}).x, 0.2,
                1e-3);
}

TEST(MitsubaOldFiles, PatternsAndFactors) {
    const auto at = [](const std::string& texture, const glm::dvec2& uv) {
        const Scene scene = loadOld(rectangleOf("<bsdf type=\"diffuse\">" + texture + "</bsdf>"));
        const Material& m = scene.materials.at(0);
        return double(m.albedo.x) * lookUp(scene, m.textures.at(0), {{uv, glm::dvec2(0)}}).x;
    };
    const std::string grid = "<texture type=\"gridtexture\" name=\"reflectance\"><float "
                             "name=\"lineWidth\" value=\"0.125\"/></texture>";
    EXPECT_NEAR(at(grid, {0.5, 0.5}), 0.2, 1e-3);
    for (const glm::dvec2 uv : {glm::dvec2(0.1, 0.5), {0.9, 0.5}, {0.5, 0.1}, {1.0, 0.9}})
        EXPECT_NEAR(at(grid, uv), 0.4, 1e-3);
    const std::string scaled = "<texture type=\"scale\" name=\"reflectance\"><float name=\"scale\" "
                               "value=\"0.5\"/><texture type=\"checkerboard\"/></texture>";
    EXPECT_NEAR(at(scaled, {0.25, 0.25}), 0.2, 1e-3);
    EXPECT_NEAR(at(scaled, {0.75, 0.25}), 0.1, 1e-3);
    const Material wire = oldMaterial("<bsdf type=\"diffuse\"><texture type=\"wireframe\" "
                                      "name=\"reflectance\"><rgb name=\"interiorColor\" "
                                      "value=\"0.25\"/></texture></bsdf>");
    EXPECT_EQ(wire.albedo, glm::vec3(0.25f));
    EXPECT_THAT(wire.textures, IsEmpty());
}

TEST(MitsubaOldFiles, ObjectsMoveFromWhereTheyBegin) {
    const Scene scene = loadOld("<shape type=\"sphere\"><animation name=\"toWorld\">"
                                "<transform time=\"0\"><translate x=\"3\"/></transform>"
                                "<transform time=\"1\"><translate x=\"4\"/></transform>"
                                "</animation></shape>");
    EXPECT_EQ(scene.spheres.at(0).center.x, 3);
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("its first transform is taken")));
}

Scene loadAncient(std::string_view inside) {
    return loadText(sceneText(inside, "0.3.0"));
}

TEST(MitsubaOldFiles, LuminairesAreEmitters) {
    const Scene scene = loadAncient("<luminaire type=\"directional\"><rgb name=\"intensity\" "
                                    "value=\"3\"/></luminaire><luminaire type=\"constant\">"
                                    "<rgb name=\"intensity\" value=\"2\"/></luminaire>");
    EXPECT_EQ(scene.lights.at(0).color, glm::vec3(3));
    EXPECT_EQ(scene.environment.value().radiance.at(0), glm::vec3(2));
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
}

/// Cameras of 0.3 were mirrored (x to the right of its look-at), and their angle was that of the
/// smaller side; those of 0.2 stated their look-at by nine numbers.
TEST(MitsubaOldFiles, CamerasAreSensors) {
    const std::string film = "<film type=\"exrfilm\"><integer name=\"width\" value=\"200\"/>"
                             "<integer name=\"height\" value=\"100\"/></film>"
                             "<float name=\"fov\" value=\"90\"/>";
    const auto camera = [&](const std::string& tag, const std::string& version,
                            const std::string& lookAt) {
        const Scene scene = loadText(sceneText("<" + tag + " type=\"perspective\">" + film +
                                                   "<transform name=\"toWorld\">" + lookAt +
                                                   "</transform></" + tag + ">",
                                               version));
        EXPECT_THAT(scene.report.forgiven, IsEmpty());
        return scene.cameras.at(0);
    };
    const std::string lookAt = "<lookAt origin=\"0,0,0\" target=\"0,0,1\" up=\"0,1,0\"/>";
    const FileCamera later = camera("sensor", "0.6.0", lookAt);
    EXPECT_NEAR(*later.halfHeight, 0.5, 1e-6);
    EXPECT_NEAR(later.right.x, -1, 1e-6);
    const FileCamera old = camera("camera", "0.3.0", lookAt);
    EXPECT_NEAR(*old.halfHeight, 1, 1e-6);
    EXPECT_NEAR(*old.halfWidth, 2, 1e-6);
    EXPECT_NEAR(old.right.x, 1, 1e-6);
    const FileCamera oldest = camera("camera", "0.2.0",
                                     "<lookAt ox=\"0\" oy=\"0\" oz=\"0\" tx=\"0\" ty=\"0\" "
                                     "tz=\"1\" ux=\"0\" uy=\"1\" uz=\"0\"/>");
    EXPECT_NEAR(oldest.right.x, -1, 1e-6);
    EXPECT_NEAR(oldest.back.z, -1, 1e-6);
}

TEST(MitsubaOldFiles, WithoutAVersionAreOld) {
    const Scene scene = loadText("<scene><shape type=\"sphere\"><transform name=\"toWorld\">"
                                 "<translate x=\"3\"/></transform></shape></scene>");
    EXPECT_EQ(scene.spheres.at(0).center.x, 3);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("has no attribute 'version'")));
}

} // namespace
} // namespace stromboli::test
