#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

Scene loadCameras(const std::string& optics, const std::string& transforms = "",
                  const std::string& asset = "", bool cs184 = false) {
    DocumentText document;
    document.asset = asset;
    document.libraries = fmt::format("<library_cameras><camera id=\"c\" name=\"Cam\"><optics>"
                                     "<technique_common>{}</technique_common></optics></camera>"
                                     "</library_cameras>",
                                     optics);
    document.nodes = fmt::format("<node>{}<instance_camera url=\"#c\"/></node>", transforms);
    return load(document, cs184);
}

FileCamera perspective(const std::string& values) {
    return loadCameras("<perspective>" + values + "</perspective>").cameras.at(0);
}

TEST(Cameras, AnyLegalPairOfAngles) {
    const auto x = perspective("<xfov>90</xfov>");
    EXPECT_NEAR(x.halfWidth.value(), 1, 1e-12);
    EXPECT_FALSE(x.halfHeight);
    EXPECT_EQ(x.projection, Projection::Perspective);
    const auto y = perspective("<yfov>45</yfov><aspect_ratio>1.5</aspect_ratio>");
    EXPECT_NEAR(y.halfHeight.value(), std::sqrt(2.0) - 1, 1e-12); // tan(22.5 degrees)
    EXPECT_NEAR(y.halfWidth.value(), 1.5 * (std::sqrt(2.0) - 1), 1e-12);
    const auto wide = perspective("<xfov>90</xfov><aspect_ratio>2</aspect_ratio>");
    EXPECT_NEAR(wide.halfHeight.value(), 0.5, 1e-12);
    const auto both = perspective("<xfov>60</xfov><yfov sid=\"y\">40</yfov>");
    EXPECT_NEAR(both.halfWidth.value(), 1 / std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(both.halfHeight.value(), std::tan(glm::radians(20.0)), 1e-12);
    // The ratio of the two is theirs, whatever else the file says of it.
    const auto three = perspective("<xfov>60</xfov><yfov>40</yfov><aspect_ratio>7</aspect_ratio>");
    EXPECT_EQ(three.halfWidth, both.halfWidth);
    EXPECT_EQ(three.halfHeight, both.halfHeight);
    EXPECT_EQ(both.name, "Cam");
}

TEST(Cameras, DepthRangeDefaultsToEverything) {
    const auto all = perspective("<xfov>90</xfov>");
    EXPECT_EQ(all.nearDistance, 0);
    EXPECT_GE(all.farDistance, 1e30);
    const auto some = perspective("<xfov>90</xfov><znear>0.5</znear><zfar>7</zfar>");
    EXPECT_EQ(some.nearDistance, 0.5);
    EXPECT_EQ(some.farDistance, 7);
}

TEST(Cameras, LengthsAreInWorldUnits) {
    const std::string ortho = "<orthographic><xmag>3</xmag><ymag>2</ymag><aspect_ratio>1.5"
                              "</aspect_ratio><znear>1</znear><zfar>10</zfar></orthographic>";
    const std::string node = "<translate>1 0 0</translate><scale>2 2 2</scale>";
    const std::string unit = "<unit meter=\"0.1\"/>";
    const FileCamera camera = loadCameras(ortho, node, unit).cameras.at(0);
    EXPECT_EQ(camera.projection, Projection::Orthographic);
    EXPECT_NEAR(camera.halfWidth.value(), 0.6, 1e-12);
    EXPECT_NEAR(camera.halfHeight.value(), 0.4, 1e-12);
    EXPECT_NEAR(camera.nearDistance, 0.2, 1e-12);
    EXPECT_NEAR(camera.farDistance, 2, 1e-12);
    expectNear(camera.position, {0.1, 0, 0});
    // That renderer neither scales by the unit nor by the node.
    const FileCamera cs184 = loadCameras(ortho, node, unit, true).cameras.at(0);
    EXPECT_EQ(cs184.nearDistance, 1);
    EXPECT_EQ(cs184.halfWidth, 3);
    expectNear(cs184.position, {1, 0, 0});
}

/// They are left out, and here nothing else is there.
TEST(Cameras, WithoutAViewAreLeftOut) {
    for (const char* bad :
         {"<perspective/>", "<perspective><aspect_ratio>1</aspect_ratio></perspective>",
          "<perspective><xfov>0</xfov></perspective>",
          "<perspective><xfov>180</xfov></perspective>",
          "<perspective><yfov>-5</yfov></perspective>",
          "<perspective><xfov>wide</xfov></perspective>", "<orthographic/>",
          "<orthographic><xmag>0</xmag></orthographic>",
          "<orthographic><ymag>INF</ymag></orthographic>"})
        EXPECT_THROW(loadCameras(bad), SceneError) << bad;
}

TEST(Cameras, NumbersThatMakeNoSenseCountAsNotStated) {
    const FileCamera usual = perspective("<xfov>40</xfov>");
    for (const char* bad :
         {"<xfov>40</xfov><aspect_ratio>0</aspect_ratio>", "<xfov>40</xfov><yfov>-5</yfov>",
          "<xfov>40</xfov><znear>5</znear><zfar>5</zfar>"}) {
        const FileCamera camera = perspective(bad);
        EXPECT_EQ(camera.halfWidth, usual.halfWidth) << bad;
        EXPECT_EQ(camera.halfHeight, usual.halfHeight) << bad;
        EXPECT_EQ(camera.farDistance, usual.farDistance) << bad;
    }
}

TEST(Cameras, SingularNodesLeaveNoCamera) {
    const Scene scene =
        loadCameras("<perspective><xfov>40</xfov></perspective>", "<scale>1 0 1</scale>");
    EXPECT_TRUE(scene.cameras.empty());
    EXPECT_THAT(scene.report.warnings, testing::Contains(testing::HasSubstr("singular")));
}

TEST(Cameras, UnequalScaleIsAWarning) {
    const Scene scene =
        loadCameras("<perspective><xfov>40</xfov></perspective>", "<scale>1 2 1</scale>");
    EXPECT_EQ(scene.cameras.size(), 1u);
    EXPECT_THAT(scene.report.warnings, testing::Contains(testing::HasSubstr("unequally")));
}

TEST(Cameras, AreInNodeOrder) {
    DocumentText document;
    for (const char* id : {"b", "a", "c"})
        document.libraries +=
            fmt::format("<library_cameras><camera id=\"{}\"><optics><technique_common><perspective>"
                        "<xfov>40</xfov></perspective></technique_common></optics></camera>"
                        "</library_cameras>",
                        id);
    document.nodes = "<node><instance_camera url=\"#a\"/><node><instance_camera url=\"#b\"/></node>"
                     "</node><node><instance_camera url=\"#c\"/></node>";
    const Scene scene = load(document);
    ASSERT_EQ(scene.cameras.size(), 3u);
    EXPECT_EQ(scene.cameras[0].name, "a");
    EXPECT_EQ(scene.cameras[1].name, "b");
    EXPECT_EQ(scene.cameras[2].name, "c");
}

} // namespace
} // namespace stromboli::test
