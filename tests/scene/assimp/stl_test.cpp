// STL files as programs write them, and as Assimp does not read them by itself.

#include "tests/scene/assimp/assimp_folder.hpp"

#include <array>
#include <cstdint>

namespace stromboli {
namespace {

using testing::HasSubstr;

/// A binary STL file of two triangles, the attributes of which are given.
std::string binaryStl(std::string header, uint32_t stated, std::array<uint16_t, 2> attributes) {
    header.resize(80, ' ');
    const auto add = [&](auto value) {
        header.append(reinterpret_cast<const char*>(&value), sizeof(value));
    };
    add(stated);
    for (int t = 0; t < 2; ++t) {
        for (const float x :
             {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 3.f * float(t), 0.f, 0.f, 3.f, 0.f})
            add(x);
        add(attributes[size_t(t)]);
    }
    return header;
}

/// Programs leave the number of triangles open, write more behind them, or are stopped.
TEST_F(AssimpFiles, StlMayHaveAnotherLengthThanItStates) {
    const std::string right = binaryStl("solid by hand", 2, {0, 0});
    const std::optional<Scene> whole = read(write("a.stl", right));
    if (!whole) GTEST_SKIP() << "Assimp is not installed";
    EXPECT_THAT(whole->report.forgiven, testing::IsEmpty());
    const std::pair<std::string, size_t> files[] = {
        {right + "\n", 2},
        {binaryStl("", 0, {0, 0}), 2},
        {binaryStl("", 7, {0, 0}), 2},
        {binaryStl("", 1, {0, 0}), 1},
        {right.substr(0, right.size() - 20), 1},
    };
    for (const auto& [bytes, triangles] : files) {
        const std::string file = write("b.stl", bytes);
        const Scene scene = *read(file);
        EXPECT_EQ(scene.triangles.size(), triangles);
        EXPECT_THAT(scene.report.forgiven, testing::ElementsAre(HasSubstr("b.stl: its header")));
        SceneConventions strict;
        strict.strict = true;
        EXPECT_THROW(read(file, strict), SceneError);
    }
    EXPECT_EQ(read(write("c.stl", std::string("\n\n  ") + kStl))->triangles.size(), 2u);
}

/// Assimp joins vertices whose colours differ, and all facets around one had the colour of the
/// first.
TEST_F(AssimpFiles, FacetsOfStlHaveTheirOwnColours) {
    const std::optional<Scene> scene =
        read(write("a.stl", binaryStl("", 2, {0x8000 | 31 << 10, 0x8000 | 31 << 5})));
    if (!scene) GTEST_SKIP() << "Assimp is not installed";
    ASSERT_EQ(scene->attributeCorners.size(), 2u);
    for (size_t t = 0; t < 2; ++t)
        for (size_t k = 0; k < 3; ++k)
            EXPECT_EQ(scene->attributes.at(scene->attributeCorners[t][k]).color,
                      t == 0 ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 1, 0, 1));
}

/// Red in the lowest five bits with the flag off, and an object's colour in the header.
TEST_F(AssimpFiles, StlOfMagicsHasItsColours) {
    const std::string header = std::string("COLOR=") + "\xFF" + std::string(1, '\0') + "\x80\xFF";
    const std::optional<Scene> whole = read(write("a.stl", binaryStl(header, 2, {0, 0x8000})));
    if (!whole) GTEST_SKIP() << "Assimp is not installed";
    const glm::vec3 albedo = whole->materials.at(whole->triangles.at(0).material).albedo;
    EXPECT_FLOAT_EQ(albedo.x, 1);
    EXPECT_EQ(albedo.y, 0);
    EXPECT_NEAR(albedo.z, 0.215861, 1e-5); // ((128 / 255 + 0.055) / 1.055)^2.4
    const Scene own = *read(write("b.stl", binaryStl(header, 2, {0x8000, 31 << 5})));
    EXPECT_EQ(own.materials.at(0).albedo, glm::vec3(1));
    ASSERT_EQ(own.attributeCorners.size(), 2u);
    const auto colorOf = [&](size_t t) {
        return own.attributes.at(own.attributeCorners.at(t)[0]).color;
    };
    EXPECT_EQ(colorOf(1), glm::vec4(0, 1, 0, 1));
    EXPECT_EQ(colorOf(0).x, 1);
    EXPECT_NEAR(colorOf(0).z, 0.215861, 0.02); // five bits have steps of 1 / 31
}

} // namespace
} // namespace stromboli
