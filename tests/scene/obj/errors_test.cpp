// Wrong files, with the message each gives.

#include "tests/scene/obj/obj_folder.hpp"

namespace stromboli::test {
namespace {

using testing::HasSubstr;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";

TEST(ObjErrors, NameFileAndLine) {
    const std::pair<std::string, std::string> cases[] = {
        {"", "a.obj: has no vertex"},
        {"f 1 2 3\n", "a.obj: has no vertex"},
        {kTriangle + "f 1 2 4\n", "a.obj:4: <f>: '4' names vertex 4, but the lines before have 3"},
        {kTriangle + "\n\nf 1 2 -4\n", "a.obj:6: <f>: '-4' names vertex -4"},
        {kTriangle + "f 1 2 0\n", "a.obj:4: <f>: '0' names vertex 0"},
        {kTriangle + "f 1/1 2 3\n", "'1/1' names texture coordinate 1"},
        {kTriangle + "f 1//2 2 3\n", "'1//2' names normal 2"},
        {kTriangle + "f 1 2 3/1/1/1\n", "'3/1/1/1' has more than three numbers"},
        {kTriangle + "f 1 2 three\n", "'three' is no corner; expected whole numbers"},
        {kTriangle + "f 1 2 99999999999999999999\n", "is no corner"},
        {kTriangle + "f 1 2 \\\n 7\n", "a.obj:4: <f>: '7' names vertex 7"},
        {"v 0 0\n", "a.obj:1: <v>: ends where a number is expected"},
        {"v 0 zero 0\n", "a.obj:1: <v>: 'zero' is no finite number"},
        {"v 0 1e999 0\n", "'1e999' is no finite number"},
        {"\xFF\xFEv", "begins as UTF-16, but is none"},
        {kTriangle + "p 1 2 3\nl 1 2\n", "a.obj: has 3 vertices and no face: expected a line 'f"},
    };
    for (const auto& [text, message] : cases)
        EXPECT_THAT(objErrorOf(text), HasSubstr(message)) << text;
}

TEST(ObjErrors, VerticesThatAreNoPointsCostTheirTriangles) {
    for (const char* vertex : {"v 0 nan 0\n", "v 0 zero 0\n", "v 0 1e999 0\n", "v 0 0\n", "v\n"}) {
        const Scene scene = loadObjText(kTriangle + vertex + "f 1 2 3\nf 1 2 4\n");
        EXPECT_EQ(scene.triangles.size(), 1u) << vertex;
        EXPECT_THAT(scene.report.warnings, testing::Contains(HasSubstr("1 of 2 triangles")));
        EXPECT_THAT(scene.report.forgiven,
                    testing::ElementsAre(HasSubstr("triangles with such a vertex are left out")));
    }
}

TEST(ObjErrors, DecimalCommasAreReadAsPoints) {
    const Scene scene = loadObjText("v 0 1,5 -2,5e-1\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    EXPECT_EQ(scene.positions.at(0), glm::vec3(0, 1.5f, -0.25f));
    EXPECT_EQ(scene.report.forgiven.size(), 1u);
}

TEST(ObjErrors, KeywordsMayHaveOtherCapitals) {
    const Scene scene = loadObjText("V 0 0 0\nv 1 0 0\nv 1 1 0\nF 1 2 3\n");
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, testing::ElementsAre(HasSubstr("in small letters")));
}

/// Files of other times end with a character that says so, or are filled up with zeros.
TEST(ObjErrors, WhatFillsUpAFileIsNoStatement) {
    const std::string text = kTriangle + "f 1 2 3\n";
    for (const std::string& end : {std::string("\x1A"), std::string(9, '\0')}) {
        const Scene scene = loadObjText(text + end);
        EXPECT_EQ(scene.triangles.size(), 1u);
        EXPECT_THAT(scene.report.forgiven, testing::IsEmpty());
    }
}

TEST(ObjErrors, TextureCoordinatesThatAreNoNumbersAre0) {
    for (const char* texcoord : {"vt 1e300 0\n", "vt u v\n", "vt\n", "vt nan 0\n"}) {
        const Scene scene = loadObjText(kTriangle + texcoord + "f 1/1 2/1 3/1\n");
        EXPECT_EQ(scene.triangles.size(), 1u) << texcoord;
        EXPECT_EQ(scene.report.forgiven.size(), 1u) << texcoord;
    }
}

TEST(ObjErrors, OneFaceCostsItself) {
    for (const char* face : {"f 1 2 9\n", "f 1 2 0\n", "f 1/7 2/7 3/7\n", "f 1 2 three\n"}) {
        const std::string text = kTriangle + face + "f 1 2 3\n";
        const Scene scene = loadObjText(text);
        EXPECT_EQ(scene.triangles.size(), 1u) << face;
        EXPECT_THAT(scene.report.forgiven, testing::ElementsAre(HasSubstr("it is left out")));
        SceneConventions strict;
        strict.strict = true;
        EXPECT_THROW(loadObjText(text, strict), SceneError) << face;
    }
}

TEST(ObjErrors, NumbersTooSmallForADoubleAre0) {
    EXPECT_EQ(loadObjText("v 1e-999 0 +0\nv +1 0 0\nv 1 1 0\nf 1 2 3\n").triangles.size(), 1u);
}

TEST(ObjErrors, StrictReadingForgivesNothing) {
    SceneConventions strict;
    strict.strict = true;
    EXPECT_THROW(loadObjText(kTriangle + "usemtl none\nf 1 2 3\n", strict), SceneError);
    EXPECT_THROW(loadObjText(kTriangle + "mtllib none.mtl\nf 1 2 3\n", strict), SceneError);
    EXPECT_THROW(loadObjText(kTriangle + "hello\nf 1 2 3\n", strict), SceneError);
    EXPECT_EQ(loadObjText(kTriangle + "f 1 2 3\n", strict).triangles.size(), 1u);
}

TEST(ObjErrors, OfMaterialsNameTheirFileAndCostNoScene) {
    const std::pair<std::string, std::string> cases[] = {
        {"Kd 1 1 1\n", "m.mtl:1: <Kd>: stands before the first 'newmtl'"},
        {"newmtl a\nKd 1 1\n", "m.mtl:2: <Kd>: ends where a number is expected"},
        {"newmtl a\nNs x\n", "m.mtl:2: <Ns>: 'x' is no finite number"},
        {"newmtl a\nmap_Kd -clamp on\n", "m.mtl:2: <map_Kd>: names no file"},
        {"newmtl a\nmap_Kd -clamp 1 a.png\n", "'1' stands where on or off is expected"},
        {"newmtl a\nmap_d -imfchan q a.png\n", "'q' is no channel"},
        {"newmtl a\nKe 1e39 0 0\n", "beyond the range of single precision"},
    };
    for (const auto& [mtl, message] : cases) {
        const ObjFolder folder;
        folder.write("m.mtl", mtl);
        const std::string text = kTriangle + "mtllib m.mtl\nusemtl a\nf 1 2 3\n";
        const Scene scene = folder.load(text);
        EXPECT_EQ(scene.triangles.size(), 1u);
        EXPECT_THAT(scene.report.forgiven, testing::Contains(HasSubstr(message)));
        SceneConventions strict;
        strict.strict = true;
        try {
            folder.load(text, strict);
            ADD_FAILURE() << mtl;
        } catch (const SceneError& error) {
            EXPECT_THAT(error.what(), HasSubstr(message));
        }
    }
}

} // namespace
} // namespace stromboli::test
