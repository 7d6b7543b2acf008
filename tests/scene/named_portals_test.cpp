// Objects that are portals in place of surfaces.
#include "host/core/error.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/named_portals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

/// Objects that are a quad each.
Scene quads(std::initializer_list<std::pair<const char*, std::array<glm::vec3, 3>>> named) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.5f));
    for (const auto& [name, q] : named) {
        const size_t first = b.scene.triangles.size();
        b.quad(q[0], q[1], q[2], white);
        b.scene.instances.emplace_back(name);
        for (size_t i = first; i < b.scene.triangles.size(); ++i)
            b.scene.triangles[i].instance = uint32_t(b.scene.instances.size() - 1);
    }
    return b.scene;
}

std::string problemWith(Scene scene, const std::vector<std::string>& names) {
    try {
        takePortals(scene, names);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

TEST(NamedPortals, AreRectanglesAndNoSurfaces) {
    const glm::vec3 a(0.6f, 0.8f, 0), b(0, 0, 3); // askew to the axes
    Scene scene = quads({{"wall", {glm::vec3(5), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}},
                         {"window", {glm::vec3(1, 2, 3), 2.0f * a, b}}});
    scene.portals.resize(3);                   // of the file
    auto& corners = scene.triangles[2].corner; // the window's first edge is its diagonal
    std::rotate(std::begin(corners), std::begin(corners) + 2, std::end(corners));
    takePortals(scene, {"window"});
    ASSERT_EQ(scene.portals.size(), 1u);
    const Portal& p = scene.portals.front();
    EXPECT_NEAR(glm::length(p.edgeA) * glm::length(p.edgeB), 6, 1e-5f);
    EXPECT_NEAR(glm::dot(p.edgeA, p.edgeB), 0, 1e-5f);
    const glm::vec3 middle = p.corner + 0.5f * (p.edgeA + p.edgeB);
    EXPECT_LT(glm::distance(middle, glm::vec3(1, 2, 3) + a + 0.5f * b), 1e-5f);
    EXPECT_EQ(scene.triangles.size(), 2u) << "the wall";
    EXPECT_EQ(scene.instances[scene.triangles.front().instance], "wall");
    EXPECT_TRUE(scene.report.assumed.empty());
}

TEST(NamedPortals, AreTheRectangleAroundOtherShapes) {
    Scene scene = quads({{"window", {glm::vec3(0), glm::vec3(2, 0, 0), glm::vec3(1, 0, 1)}}});
    takePortals(scene, {"window"});
    ASSERT_EQ(scene.report.assumed.size(), 1u);
    EXPECT_THAT(scene.report.assumed.front(), HasSubstr("portal 'window' is no rectangle"));
    const Portal& p = scene.portals.front();
    EXPECT_NEAR(glm::length(p.edgeA) * glm::length(p.edgeB), 3, 1e-4f) << "3 by 1 metres";
}

TEST(NamedPortals, WithoutNamesChangeNothing) {
    Scene scene = quads({{"window", {glm::vec3(0), glm::vec3(2, 0, 0), glm::vec3(0, 0, 1)}}});
    scene.portals.resize(2);
    takePortals(scene, {});
    EXPECT_EQ(scene.portals.size(), 2u);
    EXPECT_EQ(scene.triangles.size(), 2u);
}

TEST(NamedPortals, SayWhatIsWrong) {
    const std::array<glm::vec3, 3> flat = {glm::vec3(0), glm::vec3(2, 0, 0), glm::vec3(0, 0, 1)};
    EXPECT_THAT(problemWith(quads({{"window", flat}}), {"windw"}),
                HasSubstr("there is no object 'windw'; did you mean window?"));
    EXPECT_THAT(problemWith(quads({{"window", flat}, {"window", flat}}), {"window"}),
                HasSubstr("there are several objects 'window'"));
    Scene bent = quads({{"window", flat}});
    bent.positions[bent.triangles[1].corner[2]].y = 1;
    EXPECT_THAT(problemWith(bent, {"window"}), HasSubstr("does not lie in a plane"));
    Scene empty;
    empty.instances.emplace_back("window");
    EXPECT_THAT(problemWith(empty, {"window"}), HasSubstr("has no triangles of its own"));
}

} // namespace
} // namespace stromboli::test
