// What cannot be read is replaced or left out, and said; the rest is shown. With --strict each of
// these is an error.

#include "scene/build/texels.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string kBall = "<shape type=\"sphere\"/>\n";

/// The scene is there, with a ball; and strictly it is an error with the same words.
Scene forgiven(const std::string& inside, const std::string& words, const std::string& instead) {
    Scene scene = loadInside(kBall + inside);
    EXPECT_FALSE(scene.spheres.empty());
    EXPECT_THAT(scene.report.forgiven, Contains(AllOf(HasSubstr(words), HasSubstr(instead))));
    EXPECT_THAT(problemInside(kBall + inside), HasSubstr(words));
    return scene;
}

std::string ballOf(const std::string& inside) {
    return "<shape type=\"sphere\">" + inside + "</shape>";
}

TEST(MitsubaForgives, WhatItDoesNotKnow) {
    forgiven("<sculpture/>", "<sculpture>: is no element of a Mitsuba scene", "it is left out");
    forgiven("<shape type=\"torus\"/>", "'torus' is no shape that is read", "it is left out");
    forgiven("<emitter type=\"laser\"/>", "'laser' is no emitter that is read", "it is left out");
    forgiven("<emitter type=\"collimated\"/>", "is a beam without a width", "it is left out");
    forgiven("<emitter type=\"area\"/>", "shines on a surface", "it is left out");
    forgiven("<integrator type=\"rasterizer\"/>", "'rasterizer' is no integrator", "path");
    forgiven(ballOf("<bsdf type=\"velvet\"/>"), "'velvet' is no bsdf", "mid grey takes its place");
    forgiven(ballOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"noise\"/></bsdf>"),
             "'noise' is no texture", "there is no picture");
    forgiven(
        ballOf("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" type=\"noise\"/></bsdf>"),
        "'noise' is no spectrum", "its default is taken");
    forgiven(ballOf("<float name=\"radios\" value=\"1\"/>"), "'radios' is not read",
             "it has no effect");
}

TEST(MitsubaForgives, CamerasAreShownInPerspective) {
    const Scene scene =
        forgiven("<sensor type=\"spherical\"><film type=\"rawfilm\"><rfilter "
                 "type=\"cone\"/></film><float name=\"fov\" value=\"500\"/></sensor>",
                 "is no", "the nearest one takes its place");
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].projection, Projection::Perspective);
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("gaussian")));
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("'fov' is 500")));
    EXPECT_EQ(loadInside(kBall + "<sensor type=\"telecentric\"/>").cameras.at(0).projection,
              Projection::Orthographic);
}

TEST(MitsubaForgives, WrongNumbersAndWords) {
    const auto radius = [](const std::string& parameter) {
        return forgiven(ballOf(parameter), "", "").spheres.at(1).radius;
    };
    EXPECT_EQ(radius("<float name=\"radius\" value=\"one\"/>"), 1);
    EXPECT_EQ(radius("<string name=\"radius\" value=\"2\"/>"), 1);
    EXPECT_EQ(radius("<float name=\"radius\" value=\"2\"/><float name=\"radius\" value=\"3\"/>"),
              2);
    EXPECT_EQ(radius("<float name=\"radius\" value=\"2\" colour=\"red\"/>"), 2);
    EXPECT_EQ(
        forgiven(ballOf("<transform name=\"to_world\"><translate x=\"1\"/><turn/></transform>"),
                 "is no step of a transform", "it has no effect")
            .spheres.at(1)
            .center.x,
        1);
    const Scene rough = forgiven(ballOf("<bsdf type=\"roughconductor\"><float name=\"alpha\" "
                                        "value=\"-1\"/></bsdf>"),
                                 "'alpha' is -1, expected 0 to", "the nearest one in it");
    EXPECT_EQ(rough.materials.at(1).facets.alpha.x, 0);
    const Scene glass = forgiven(ballOf("<bsdf type=\"dielectric\"><string name=\"int_ior\" "
                                        "value=\"mud\"/></bsdf>"),
                                 "'int_ior' is 'mud'", "its default is taken");
    EXPECT_FLOAT_EQ(glass.materials.at(1).ior, 1.5046f / 1.000277f);
    const Scene metal = forgiven(ballOf("<bsdf type=\"conductor\"><string name=\"material\" "
                                        "value=\"Unobtainium\"/></bsdf>"),
                                 "'material' is 'Unobtainium'", "Cu");
    EXPECT_FLOAT_EQ(metal.materials.at(1).k.x, 3.912949f);
}

/// An index below 0 would reflect more than all light.
TEST(MitsubaForgives, IndicesBelowZero) {
    const Scene scene =
        forgiven(ballOf("<bsdf type=\"roughconductor\"><rgb name=\"eta\" value=\"-0.5 4 5\"/>"
                        "<rgb name=\"k\" value=\"-0.25 0.5 1\"/></bsdf>"),
                 "'eta' is -0.5, expected 0 or more", "the nearest one in it is taken");
    EXPECT_EQ(scene.materials.at(1).eta, glm::vec3(0, 4, 5));
    EXPECT_EQ(scene.materials.at(1).k, glm::vec3(0, 0.5f, 1));
}

/// Whole numbers may be written as floats.
TEST(MitsubaForgives, FloatsThatAreWhole) {
    EXPECT_EQ(loadInside("<integrator type=\"path\"><float name=\"max_depth\" value=\"4\"/>"
                         "</integrator>")
                  .hints.maxBounces,
              3u);
    EXPECT_THAT(problemInside("<integrator type=\"path\"><float name=\"max_depth\" "
                              "value=\"4.5\"/></integrator>"),
                HasSubstr("is a float, expected an integer"));
}

TEST(MitsubaForgives, FilesThatAreNotThere) {
    forgiven("<shape type=\"ply\"><string name=\"filename\" value=\"no.ply\"/></shape>",
             "names the file 'no.ply', which is not there", "it is left out");
    forgiven("<include filename=\"no.xml\"/>", "names the file 'no.xml'", "it is left out");
    writeFile("broken.xml", "<scene version=\"3.0.0\"><shape");
    forgiven("<include filename=\"broken.xml\"/>", "not well-formed XML", "it is left out");
    forgiven("<path value=\"nowhere\"/>", "there is no folder", "it is left out");
    forgiven("<emitter type=\"envmap\"><string name=\"filename\" value=\"no.exr\"/></emitter>",
             "names the file 'no.exr'", "it is left out");
    const Scene scene = forgiven(
        ballOf("<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string "
               "name=\"filename\" value=\"no.png\"/></texture></bsdf>"),
        "names the file 'no.png'", "there is no picture on the surface");
    EXPECT_EQ(scene.materials.at(1).albedo, glm::vec3(0.5f));
    writeFile("damaged.png", "no picture at all");
    const Scene masked = forgiven(
        ballOf(
            "<bsdf type=\"mask\"><texture type=\"bitmap\" name=\"opacity\"><string "
            "name=\"filename\" value=\"damaged.png\"/></texture><bsdf type=\"diffuse\"/></bsdf>"),
        "damaged.png", "there is no picture on the surface");
    EXPECT_EQ(masked.materials.at(1).opacity, 1); // it is there
}

/// Files were named where capitals do not matter.
TEST(MitsubaForgives, NamesOfOtherMachines) {
    const std::filesystem::path folder = writeFile("a", "").parent_path() / "models";
    std::filesystem::create_directories(folder);
    std::filesystem::rename(writeFile("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                            folder / "t.obj");
    const Scene scene = loadInside("<shape type=\"obj\"><string name=\"filename\" "
                                   "value=\"Models\\T.OBJ\"/></shape>");
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(HasSubstr("other capitals")));
}

TEST(MitsubaForgives, ReferencesThatLeadNowhere) {
    const Scene scene = forgiven(ballOf("<ref id=\"nothing\"/>"),
                                 "there is no object with the id 'nothing'", "it counts as absent");
    EXPECT_EQ(scene.spheres.size(), 2u);
    forgiven("<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>"
             "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>" +
                 ballOf("<ref id=\"a\"/>"),
             "lies inside itself, by references", "it counts as absent");
    forgiven("<bsdf type=\"null\" id=\"a\"/>\n<bsdf type=\"null\" id=\"a\"/>",
             "has the id 'a', which is that of", "it counts as absent");
}

TEST(MitsubaForgives, Seconds) {
    const Scene scene = forgiven("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"2\"/>"
                                 "</emitter><emitter type=\"sunsky\"/>",
                                 "is the second environment", "it is left out");
    EXPECT_EQ(scene.environment.value().name, "constant");
    const Scene two =
        forgiven(ballOf("<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"1\"/>"
                        "</bsdf><bsdf type=\"plastic\"/>"),
                 "is the second bsdf of this shape", "it is left out");
    EXPECT_EQ(two.materials.at(1).albedo, glm::vec3(1));
}

TEST(MitsubaForgives, BsdfsThatDoNotFit) {
    forgiven(ballOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" "
                    "type=\"vertexcolors\"/></bsdf>"),
             "has a bsdf with a mesh attribute", "the mesh is shown without it");
    const std::string blend = "<bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/>"
                              "<bsdf type=\"plastic\"/></bsdf>";
    const Scene scene =
        forgiven(ballOf("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.75\"/>" + blend +
                        blend + "</bsdf>"),
                 "has a first bsdf that is a blend", "that of both with the larger share");
    EXPECT_NE(scene.materials.at(scene.spheres.at(1).material).other, kNoMaterial);
    forgiven(ballOf("<bsdf type=\"twosided\"/>"), "has 0 bsdfs inside", "mid grey");
    forgiven(ballOf("<bsdf type=\"twosided\">" + blend + blend + "</bsdf>"),
             "has two bsdfs that are blends", "the front on both sides");
    const std::string board = "<texture type=\"checkerboard\"/>";
    forgiven(ballOf("<bsdf type=\"bumpmap\">" + board + "<bsdf type=\"bumpmap\">" + board +
                    "<bsdf type=\"diffuse\"/></bsdf></bsdf>"),
             "is a bump map over another map of normals", "there is no picture");
}

/// Neither the time nor the stack that a scene takes doubles with each line of it.
TEST(MitsubaForgives, MixturesOfMixtures) {
    std::string inside = "<bsdf type=\"diffuse\" id=\"b0\"/>\n";
    for (int i = 1; i <= 60; ++i)
        inside += fmt::format("<bsdf type=\"mixturebsdf\" id=\"b{}\"><string name=\"weights\" "
                              "value=\"0.5 0.5\"/><ref name=\"x\" id=\"b{}\"/><ref name=\"y\" "
                              "id=\"b{}\"/></bsdf>\n",
                              i, i - 1, i - 1);
    EXPECT_EQ(loadInside(inside + ballOf("<ref id=\"b60\"/>")).spheres.size(), 1u);
    std::string weights, many;
    for (int i = 0; i < 5000; ++i) {
        weights += "0.0002 ";
        many += "<bsdf type=\"diffuse\"/>";
    }
    forgiven(ballOf("<bsdf type=\"mixturebsdf\"><string name=\"weights\" value=\"" + weights +
                    "\"/>" + many + "</bsdf>"),
             "is a mixture of more than 256 bsdfs", "that of both with the larger share");
}

/// Where a number or colour alone is possible, a picture has a mean.
TEST(MitsubaForgives, PicturesAsNumbers) {
    const Scene scene = forgiven(
        ballOf(
            "<bsdf type=\"roughplastic\"><texture name=\"alpha\" type=\"checkerboard\"/></bsdf>"),
        "'alpha' is a texture", "its mean");
    EXPECT_NEAR(scene.materials.at(1).facets.alpha.x, 0.3, 1e-3);
    const Scene glass =
        forgiven(ballOf("<bsdf type=\"dielectric\"><texture "
                        "name=\"specular_transmittance\" type=\"checkerboard\"/></bsdf>"),
                 "'specular_transmittance' is a texture", "its mean");
    EXPECT_NEAR(glass.materials.at(1).transmittance.x, 0.3, 1e-3);
    const Scene squares =
        forgiven(ballOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" "
                        "type=\"checkerboard\"><texture name=\"color0\" type=\"checkerboard\"/>"
                        "</texture></bsdf>"),
                 "'color0' is a texture", "its mean");
    EXPECT_NEAR(build::colorAt(squares.images.at(1), 0, false).x, 0.3, 1e-3);
    const Scene volume = loadInside(
        ballOf("<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"volume\"><volume "
               "type=\"constvolume\"><rgb name=\"value\" value=\"0.25 0.5 0.75\"/></volume>"
               "</texture></bsdf>"));
    EXPECT_THAT(volume.report.forgiven, IsEmpty());
    EXPECT_EQ(volume.materials.at(0).albedo, glm::vec3(0.25, 0.5, 0.75));
}

TEST(MitsubaForgives, Media) {
    const Scene scene =
        forgiven(ballOf("<medium name=\"interior\" type=\"plasma\"/><subsurface "
                        "type=\"octopole\"/>") +
                     "<sensor type=\"perspective\"><medium type=\"plasma\"/></sensor>",
                 "<medium>: 'plasma' is no medium that is read", "the scene is shown without it");
    EXPECT_TRUE(scene.media.empty());
    EXPECT_EQ(scene.spheres.size(), 2u);
    EXPECT_EQ(scene.cameras.size(), 1u);
}

/// Lines are counted: there is one for each kind.
TEST(MitsubaForgives, InOneLineForEachKind) {
    std::string inside;
    for (int i = 0; i < 5; ++i)
        inside += ballOf(fmt::format("<float name=\"wrong{}\" value=\"1\"/>", i));
    const Scene scene = loadInside(kBall + inside);
    EXPECT_THAT(scene.report.forgiven,
                ElementsAre(AllOf(HasSubstr("3: <float>: 'wrong0'"), HasSubstr("(5 times)"))));
}

/// A camera that looks along its own `up` still looks where it is meant to.
TEST(MitsubaForgives, UpsThatAreAhead) {
    const Scene scene = forgiven("<sensor type=\"perspective\"><transform name=\"to_world\">"
                                 "<lookat origin=\"0 9 0\" target=\"0 0 0\" up=\"0 1 0\"/>"
                                 "</transform></sensor>",
                                 "looks along 'up'", "it has no effect");
    EXPECT_EQ(scene.cameras.at(0).position, glm::dvec3(0, 9, 0));
    EXPECT_NEAR(scene.cameras.at(0).back.y, 1, 1e-12);
}

TEST(MitsubaForgives, VersionsThatAreNone) {
    EXPECT_EQ(loadText(sceneText(kBall, "new")).spheres.size(), 1u);
    EXPECT_EQ(loadText(sceneText(kBall, "")).spheres.size(), 1u);
}

TEST(MitsubaForgives, NotWhatLeavesNothing) {
    const auto problem = [](const std::string& inside) {
        try {
            loadInside(inside);
        } catch (const SceneError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(problem("<shape type=\"torus\"/>"), HasSubstr("'torus' is no shape that is read"));
    EXPECT_THAT(problem(kBall + "<shape type=\"$kind\"/>"),
                HasSubstr("refers to '$kind', which has no value"));
    EXPECT_THAT(problem(kBall + "<shape type=\"sphere\">"), HasSubstr("not well-formed XML"));
    EXPECT_THROW(loadText("<sculpture/>"), SceneError);
    EXPECT_THROW(loadText(sceneText(kBall), {{"unknown", "1"}}), SceneError);
}

/// A first one that is a blend takes the place, in the rest of a share that a picture says.
TEST(MitsubaForgives, NoBlendsOfBlendsByPictures) {
    const std::string blend =
        "<bsdf type=\"blendbsdf\"><bsdf type=\"diffuse\"/><bsdf type=\"conductor\"/></bsdf>";
    const Scene scene = loadInside(
        rectangleOf("<bsdf type=\"blendbsdf\"><texture name=\"weight\" type=\"scale\"><float "
                    "name=\"scale\" value=\"0.5\"/><texture type=\"checkerboard\"><float "
                    "name=\"color0\" value=\"0.25\"/><float name=\"color1\" "
                    "value=\"0.75\"/></texture></texture>" +
                    blend + "<bsdf type=\"plastic\"/></bsdf>"));
    EXPECT_TRUE(scene.report.forgiven.empty());
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(m.kind, MaterialKind::Plastic);
    EXPECT_EQ(m.otherShare, 1.0f);
    EXPECT_EQ(scene.materials.at(m.other).kind, MaterialKind::Diffuse);
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::BlendShare);
    const TextureImage& image = scene.images.at(scene.textures.at(m.textures[0].texture).image);
    // Of numbers the first square has color1.
    EXPECT_EQ(build::colorAt(image, 0, false).x, 1 - 0.5 * 0.75);
    EXPECT_EQ(build::colorAt(image, 1, false).x, 1 - 0.5 * 0.25);
}

TEST(MitsubaForgives, NothingOfWhatIsRight) {
    const Scene scene = loadInside(ballOf("<bsdf type=\"diffuse\"><texture type=\"rawconstant\" "
                                          "name=\"reflectance\"><vector name=\"value\" "
                                          "value=\"0.25 0.5 0.75\"/></texture></bsdf>"));
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0.25f, 0.5f, 0.75f));
    EXPECT_EQ(problemInside("<emitter type=\"point\"><spectrum type=\"d65\" name=\"intensity\">"
                            "<float name=\"scale\" value=\"2\"/></spectrum></emitter>"
                            "<emitter type=\"point\"><spectrum type=\"irregular\" "
                            "name=\"intensity\"><string name=\"wavelengths\" value=\"400, 700\"/>"
                            "<string name=\"values\" value=\"1, 2\"/></spectrum></emitter>"
                            "<emitter type=\"point\"><spectrum type=\"regular\" "
                            "name=\"intensity\"><float name=\"wavelength_min\" value=\"400\"/>"
                            "<float name=\"wavelength_max\" value=\"700\"/>"
                            "<string name=\"values\" value=\"1, 2\"/></spectrum></emitter>"
                            "<emitter type=\"point\"><spectrum type=\"blackbody\" "
                            "name=\"intensity\"><float name=\"temperature\" value=\"3000\"/>"
                            "</spectrum></emitter>"),
              "");
}

} // namespace
} // namespace stromboli::test
