// All kinds of primitives, and their materials.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

#include <array>

namespace stromboli::test {
namespace {

/// The corners' x coordinates of the triangles made from these primitives. Position i is at x = i
/// on a parabola, so that corners have names and no three are on a line.
std::vector<std::array<int, 3>> triangles(const std::string& primitives) {
    DocumentText document;
    document.libraries = meshLibrary("0 0 0 1 1 0 2 4 0 3 9 0 4 16 0 5 25 0", 18, primitives);
    document.nodes = meshNode();
    const Scene scene = load(document);
    std::vector<std::array<int, 3>> found;
    for (size_t t = 0; t < scene.triangles.size(); ++t)
        found.push_back(
            {int(corner(scene, t, 0).x), int(corner(scene, t, 1).x), int(corner(scene, t, 2).x)});
    return found;
}

std::string primitive(const std::string& kind, int count, const std::string& rest) {
    return fmt::format("<{0} count=\"{1}\">{2}{3}</{0}>", kind, count, kVertexInput, rest);
}

using Found = std::vector<std::array<int, 3>>;

TEST(Primitives, Triangles) {
    EXPECT_EQ(triangles(primitive("triangles", 2, "<p>0 1 2 3 2 1</p>")),
              (Found{{0, 1, 2}, {3, 2, 1}}));
}

TEST(Primitives, Polylist) {
    EXPECT_EQ(triangles(primitive("polylist", 2, "<vcount>3 4</vcount><p>3 1 2 0 1 2 3</p>")),
              (Found{{3, 1, 2}, {0, 1, 2}, {0, 2, 3}}));
}

TEST(Primitives, PolygonsWithHolesUseTheOutline) {
    EXPECT_EQ(triangles(primitive("polygons", 2,
                                  "<p>0 1 2</p><ph><p>1 2 3</p><h>0 1 2</h><h>0 1 2</h></ph>")),
              (Found{{0, 1, 2}, {1, 2, 3}}));
}

TEST(Primitives, StripsKeepTheirSide) {
    EXPECT_EQ(triangles(primitive("tristrips", 2, "<p>0 1 2 3 4</p><p>3 4 5</p>")),
              (Found{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {3, 4, 5}}));
}

TEST(Primitives, Fans) {
    EXPECT_EQ(triangles(primitive("trifans", 2, "<p>0 1 2 3</p><p>3 4 5</p>")),
              (Found{{0, 1, 2}, {0, 2, 3}, {3, 4, 5}}));
}

TEST(Primitives, ShortOnesMakeNoTriangles) {
    EXPECT_EQ(triangles(primitive("trifans", 2, "<p>0 1</p><p></p>")), Found{});
    EXPECT_EQ(triangles(primitive("tristrips", 1, "<p>0 1</p>")), Found{});
    EXPECT_EQ(triangles(primitive("polylist", 3, "<vcount>2 0 3</vcount><p>0 1 0 1 2</p>")),
              (Found{{0, 1, 2}}));
    EXPECT_EQ(triangles(primitive("polylist", 0, "")), Found{});
}

TEST(Primitives, WrongCountsAndIndicesAreErrors) {
    for (const std::string& bad : {
             primitive("triangles", 1, "<p>0 1</p>"),
             primitive("triangles", 1, "<p>0 1 6</p>"),
             primitive("triangles", 1, "<p>0 1 -1</p>"),
             primitive("triangles", 1, "<p>0 1 4294967297</p>"),
             primitive("triangles", 1, "<p>0 1 2.0</p>"),
             primitive("polylist", 1, "<vcount>4</vcount><p>0 1 2</p>"),
             primitive("polylist", 1, "<vcount>2</vcount><p>0 1 2</p>"),
             primitive("polylist", 2, "<vcount>4294967295 4</vcount><p>0 1 2</p>"),
             primitive("polylist", 1, "<p>0 1 2</p>"),
             primitive("polylist", 1, "<vcount>3</vcount>"),
             primitive("polygons", 1, "<ph><h>0 1 2</h></ph>"),
             std::string("<triangles count=\"1\"><p>0 1 2</p></triangles>"),
             std::string("<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\"/>"
                         "<p>0 1 2</p></triangles>"),
             std::string("<triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" "
                         "offset=\"4294967295\"/><p>0 1 2</p></triangles>"),
         })
        EXPECT_THROW(triangles(bad), SceneError) << bad;
}

TEST(Primitives, WrongCountsCostNothingThatIsThere) {
    EXPECT_EQ(triangles(primitive("triangles", 1, "<p>0 1 2 3 2 1</p>")).size(), 2u);
    EXPECT_EQ(triangles(primitive("polylist", 2, "<vcount>3</vcount><p>0 1 2</p>")).size(), 1u);
    EXPECT_EQ(triangles(primitive("polygons", 2, "<p>0 1 2</p>")).size(), 1u);
    EXPECT_EQ(triangles(primitive("tristrips", 2, "<p>0 1 2</p>")).size(), 1u);
    EXPECT_EQ(triangles(primitive("trifans", 2, "<p>0 1 2</p>")).size(), 1u);
}

TEST(Primitives, GroupsHaveTheirOwnMaterials) {
    const auto group = [](const char* material) {
        return fmt::format("<triangles count=\"1\"{}>{}<p>0 1 2</p></triangles>", material,
                           kVertexInput);
    };
    const auto effect = [](const char* id, const char* color) {
        return fmt::format("<effect id=\"{}\"><profile_COMMON><technique sid=\"t\"><lambert>"
                           "<diffuse><color>{}</color></diffuse></lambert></technique>"
                           "</profile_COMMON></effect>",
                           id, color);
    };
    DocumentText document;
    document.libraries =
        "<library_effects>" + effect("re", "0.9 0 0 1") + effect("ge", "0 0.9 0 1") +
        "</library_effects><library_materials>"
        "<material id=\"red\"><instance_effect url=\"#re\"/></material>"
        "<material id=\"green\" name=\"Green\"><instance_effect url=\"#ge\"/></material>"
        "</library_materials>" +
        meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                    group(" material=\"A\"") + group(" material=\"B\"") + group(""));
    const auto node = [](const char* a, const char* b) {
        return fmt::format("<node><instance_geometry url=\"#mesh\"><bind_material>"
                           "<technique_common><instance_material symbol=\"A\" target=\"#{}\"/>"
                           "<instance_material symbol=\"B\" target=\"#{}\"/></technique_common>"
                           "</bind_material></instance_geometry></node>",
                           a, b);
    };
    document.nodes = node("red", "green") + node("green", "red");
    const Scene scene = load(document);
    ASSERT_EQ(scene.triangles.size(), 6u);
    EXPECT_EQ(scene.materials.size(), 3u);
    const auto albedo = [&](size_t t) {
        return scene.materials[scene.triangles[t].material].albedo;
    };
    const glm::vec3 red(0.9f, 0, 0), green(0, 0.9f, 0), grey(0.5f);
    EXPECT_EQ(albedo(0), red);
    EXPECT_EQ(albedo(1), green);
    EXPECT_EQ(albedo(2), grey);
    EXPECT_EQ(albedo(3), green);
    EXPECT_EQ(albedo(4), red);
    EXPECT_EQ(scene.materials[scene.triangles[1].material].name, "Green");
    EXPECT_THAT(scene.report.warnings,
                testing::Contains(testing::AllOf(testing::HasSubstr("without a bound material"),
                                                 testing::HasSubstr("2 times"))));
}

} // namespace
} // namespace stromboli::test
