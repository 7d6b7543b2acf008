// The elements of a scene, whatever its plugins are.

#include "scene/build/spectrum.hpp"
#include "scene/mitsuba/upgrade.hpp"
#include "scene/read_scene.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

namespace stromboli::test {
namespace {

using testing::HasSubstr;

const std::string kSphere = "<shape type=\"sphere\"/>";

TEST(MitsubaXml, AnEmptySceneLoads) {
    const Scene scene = loadInside("");
    EXPECT_TRUE(scene.triangles.empty());
}

TEST(MitsubaXml, IsToldByItsRoot) {
    EXPECT_TRUE(looksLikeMitsuba("<?xml version=\"1.0\"?>\n<!-- a -->\n<scene version='2.0.0'>"));
    EXPECT_FALSE(looksLikeMitsuba("<COLLADA>"));
    EXPECT_FALSE(looksLikeMitsuba("<scenery>"));
}

TEST(MitsubaXml, WrongDocuments) {
    EXPECT_EQ(problemOf("<shape type='sphere' version='3.0.0'/>"),
              "1: <shape>: the root element must be <scene>");
    EXPECT_THAT(problemOf("<scene></scene>"), HasSubstr("1: <scene>: has no attribute 'version'"));
    EXPECT_THAT(problemOf("<scene version='3.0.0'>"), HasSubstr("not well-formed XML"));
    EXPECT_THAT(problemOf("<scene version='new'/>"), HasSubstr("is not a whole number"));
}

TEST(MitsubaXml, NamesHaveValues) {
    const std::string text = sceneText("<default name=\"r\" value=\"2\"/>\n"
                                       "<default name=\"radius\" value=\"3\"/>\n"
                                       "<shape type=\"sphere\">\n"
                                       "<float name=\"radius\" value=\"$radius\"/></shape>");
    EXPECT_EQ(loadText(text).spheres.at(0).radius, 3); // the longest name, not $r
    EXPECT_EQ(loadText(text, {{"radius", "5"}}).spheres.at(0).radius, 5);
    EXPECT_THAT(problemOf(text, {{"unknown", "5"}}), HasSubstr("nothing in the scene refers to"));
    EXPECT_EQ(problemInside("<shape type=\"$kind\"/>"),
              "2: <shape>: refers to '$kind', which has no value: expected a <default> before it, "
              "or -D NAME=VALUE");
}

TEST(MitsubaXml, ReferencesMayComeFirst) {
    const Scene scene = loadInside("<shape type=\"sphere\"><ref id=\"red\"/></shape>\n"
                                   "<bsdf type=\"diffuse\" id=\"red\">"
                                   "<rgb name=\"reflectance\" value=\"1 0 0\"/></bsdf>\n"
                                   "<alias id=\"red\" as=\"rot\"/>"
                                   "<shape type=\"sphere\"><ref id=\"rot\"/></shape>");
    ASSERT_EQ(scene.spheres.size(), 2u);
    EXPECT_EQ(scene.materials.at(scene.spheres[0].material).albedo, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.spheres[0].material, scene.spheres[1].material);
}

TEST(MitsubaXml, WrongReferences) {
    EXPECT_EQ(problemInside("<shape type=\"sphere\"><ref id=\"red\"/></shape>"),
              "2: <ref>: there is no object with the id 'red'");
    EXPECT_EQ(problemInside("<bsdf type=\"twosided\" id=\"a\"><ref id=\"b\"/></bsdf>\n"
                            "<bsdf type=\"twosided\" id=\"b\"><ref id=\"a\"/></bsdf>"),
              "2: <bsdf>: lies inside itself, by references");
    EXPECT_THAT(problemInside("<bsdf type=\"null\" id=\"a\"/>\n<bsdf type=\"null\" id=\"a\"/>"),
                HasSubstr("3: <bsdf>: has the id 'a', which is that of"));
}

TEST(MitsubaXml, FilesIncludeOthers) {
    writeFile("ball.xml", kSphere);
    writeFile("balls.xml", sceneText(kSphere + kSphere));
    const Scene scene = loadInside("<include filename=\"ball.xml\"/>"
                                   "<include filename=\"balls.xml\"/>");
    EXPECT_EQ(scene.spheres.size(), 3u);
    EXPECT_EQ(problemInside("<include filename=\"no.xml\"/>"),
              "2: <include>: names the file 'no.xml', which is not there");
    writeFile("circle.xml", sceneText("<include filename=\"circle.xml\"/>"));
    EXPECT_THAT(problemInside("<include filename=\"circle.xml\"/>"),
                HasSubstr("include each other more than 15 levels deep"));
    writeFile("twice.xml", sceneText("<include filename=\"twice2.xml\"/>"
                                     "<include filename=\"twice2.xml\"/>"));
}

TEST(MitsubaXml, FoldersAreSearched) {
    const std::filesystem::path folder = writeFile("a", "").parent_path() / "inner";
    std::filesystem::create_directories(folder);
    std::filesystem::rename(writeFile("found.xml", kSphere), folder / "found.xml");
    EXPECT_EQ(loadInside("<path value=\"inner\"/><include filename=\"found.xml\"/>").spheres.size(),
              1u);
    EXPECT_THAT(problemInside("<path value=\"nowhere\"/>"),
                HasSubstr("<path>: there is no folder"));
}

TEST(MitsubaXml, TransformsApplyInTheirOrder) {
    const Scene scene = loadInside("<shape type=\"sphere\"><transform name=\"to_world\">"
                                   "<translate x=\"1\"/><scale value=\"2\"/>"
                                   "<rotate z=\"1\" angle=\"90\"/>"
                                   "<matrix value=\"1 0 0 0 0 1 0 0 0 0 1 7 0 0 0 1\"/>"
                                   "</transform></shape>");
    const Sphere& sphere = scene.spheres.at(0);
    EXPECT_NEAR(glm::distance(sphere.center, glm::vec3(0, 2, 7)), 0, 1e-6);
    EXPECT_FLOAT_EQ(sphere.radius, 2);
}

TEST(MitsubaXml, WrongValues) {
    const auto sphere = [](const std::string& inside) {
        return problemInside("<shape type=\"sphere\">" + inside + "</shape>");
    };
    EXPECT_EQ(sphere("<float name=\"radius\" value=\"one\"/>"),
              "2: <float>: 'one' is not a finite number");
    EXPECT_EQ(sphere("<integer name=\"radius\" value=\"1.5\"/>"),
              "2: <integer>: '1.5' is not a whole number");
    EXPECT_EQ(sphere("<boolean name=\"flip_normals\" value=\"yes\"/>"),
              "2: <boolean>: 'yes' is neither true nor false");
    EXPECT_EQ(sphere("<point name=\"center\" value=\"1, 2\"/>"),
              "2: <point>: has 2 numbers, expected 3 or 1");
    EXPECT_EQ(sphere("<string name=\"radius\" value=\"1\"/>"),
              "2: <string>: 'radius' is a string, expected a float");
    EXPECT_EQ(sphere("<float name=\"radius\"/>"), "2: <float>: has no attribute 'value'");
    EXPECT_EQ(sphere("<float name=\"radius\" valu=\"1\"/>"),
              "2: <float>: has the attribute 'valu', expected one of name, value, filename, "
              "intent, unit");
    EXPECT_EQ(sphere("<float name=\"radius\" value=\"1\"/><float name=\"radius\" value=\"1\"/>"),
              "2: <float>: 'radius' is set already in this shape");
    EXPECT_THAT(sphere("<float name=\"radios\" value=\"1\"/>"),
                HasSubstr("2: <float>: 'radios' is not read in shape 'sphere'; expected one of "));
    EXPECT_EQ(sphere("<transform name=\"to_world\"><turn/></transform>"),
              "2: <turn>: is no step of a transform, expected translate, rotate, scale, lookat or "
              "matrix");
    EXPECT_THAT(problemInside("<shape type=\"torus\"/>"),
                HasSubstr("2: <shape>: 'torus' is no shape that is read, expected obj, ply"));
}

TEST(MitsubaXml, OldNamesAreUpgraded) {
    EXPECT_EQ(mitsuba::upgradedName("toWorld"), "to_world");
    EXPECT_EQ(mitsuba::upgradedName("intIOR"), "int_ior");
    const std::string inside = "<shape type=\"sphere\"><transform name=\"toWorld\">"
                               "<translate x=\"3\"/></transform></shape>";
    EXPECT_EQ(loadText(sceneText(inside, "0.6.0")).spheres.at(0).center.x, 3);
    EXPECT_THAT(problemInside(inside), HasSubstr("'toWorld' is not read"));
}

TEST(MitsubaXml, SpectraAlikeEverywhereComeOutExactly) {
    const std::vector<std::pair<double, double>> flat = {{300, 0.25}, {900, 0.25}};
    const glm::dvec3 light = build::rgbOfLight(flat);
    const glm::dvec3 reflectance = build::rgbOfReflectance(flat);
    for (const int channel : {0, 1, 2}) {
        EXPECT_NEAR(light[channel], 0.25 * build::kEqualEnergy[channel], 2e-4);
        EXPECT_NEAR(reflectance[channel], 0.25, 1e-4);
    }
}

/// Programs of Mitsuba 0.x that are built for many wavelengths list a number for each.
TEST(MitsubaXml, SpectraMayBeListsOfNumbers) {
    const auto colorOf = [](const std::string& spectrum) {
        const std::string inside = rectangleOf("<bsdf type=\"diffuse\"><spectrum "
                                               "name=\"reflectance\" value=\"" +
                                               spectrum + "\"/></bsdf>");
        EXPECT_EQ(problemInOld(inside), "");
        const Scene scene = loadOld(inside);
        return scene.materials.at(scene.triangles.at(0).material).albedo;
    };
    EXPECT_NEAR(colorOf("0.25, 0.25, 0.25, 0.25, 0.25").y, 0.25, 1e-4);
    // Five parts of 94 nm from 360 nm on.
    const glm::vec3 listed = colorOf("0.1 0.2 0.4 0.6 0.7");
    const glm::vec3 pairs = colorOf("360:0.1 407:0.1 501:0.2 595:0.4 689:0.6 783:0.7 830:0.7");
    EXPECT_LT(glm::distance(listed, pairs), 1e-6f);
}

/// Against the CIE 1931 curves at 700 and 546.1 nm: chromaticity (0.73469, 0.26531) and
/// (0.27377, 0.71741).
TEST(MitsubaXml, NarrowSpectraHaveTheirHue) {
    const glm::dvec3 green =
        build::rgbOfLight(std::vector<std::pair<double, double>>{{540, 1}, {552, 1}});
    EXPECT_GT(green.y, green.x);
    EXPECT_EQ(green.z, 0); // outside of the primaries
}

/// Tools of Windows write it, and say so by a mark or the first character alone.
TEST(MitsubaXml, MayBeInUtf16) {
    const std::string text = sceneText("<shape type=\"sphere\"/>");
    std::string wide;
    for (const char c : text)
        wide += {c, '\0'};
    for (const std::string mark : {"", "\xFF\xFE"})
        EXPECT_EQ(loadText(mark + wide).spheres.size(), 1u);
    EXPECT_THAT(problemOf("\xFF\xFE" + wide.substr(0, wide.size() - 1)),
                testing::HasSubstr("begins as UTF-16, but is none"));
}

} // namespace
} // namespace stromboli::test
