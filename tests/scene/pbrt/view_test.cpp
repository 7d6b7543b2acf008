// Cameras, films, filters, integrators and transformations.

#include "tests/scene/pbrt/pbrt_text.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

FileCamera cameraOf(const std::string& before) {
    const Scene scene = loadText(before + " WorldBegin " + kTriangle);
    EXPECT_EQ(scene.cameras.size(), 1u);
    return scene.cameras.at(0);
}

void expectClose(const glm::dvec3& a, const glm::dvec3& b) {
    for (const int i : {0, 1, 2})
        EXPECT_NEAR(a[i], b[i], 1e-6) << i;
}

TEST(PbrtCamera, LooksAlongZWithXToTheRight) {
    const FileCamera camera = cameraOf("Camera \"perspective\"");
    expectClose(camera.right, {1, 0, 0});
    expectClose(camera.up, {0, 1, 0});
    expectClose(camera.back, {0, 0, -1});
}

TEST(PbrtCamera, LookAtIsLeftHanded) {
    const FileCamera camera = cameraOf("LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\"");
    expectClose(camera.position, {0, 0, -5});
    expectClose(camera.right, {1, 0, 0});
    expectClose(camera.back, {0, 0, -1});
    const FileCamera mirrored =
        cameraOf("Scale -1 1 1 LookAt 0 0 -5  0 0 0  0 1 0 Camera \"perspective\"");
    expectClose(mirrored.right, {-1, 0, 0});
    expectClose(mirrored.position, {0, 0, -5});
}

TEST(PbrtCamera, TransformationsAreMultipliedInTheirOrder) {
    const FileCamera camera = cameraOf("Rotate 90 0 1 0 Translate -1 -2 -3 Camera \"perspective\"");
    expectClose(camera.position, {1, 2, 3});
    expectClose(camera.back, {1, 0, 0}); // z of the camera is -x of the world
    expectClose(
        cameraOf("Transform [1 0 0 0 0 1 0 0 0 0 1 0 4 5 6 1] Camera \"perspective\"").position,
        {-4, -5, -6});
    expectClose(
        cameraOf("Translate 9 9 9 Identity Translate 1 0 0 ConcatTransform [1 0 0 0 0 1 0 0 "
                 "0 0 1 0 0 2 0 1] Camera \"perspective\"")
            .position,
        {-1, -2, 0});
}

TEST(PbrtCamera, AngleIsThatOfTheShorterSide) {
    const std::string wide =
        "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100 ";
    const FileCamera camera = cameraOf(wide + "Camera \"perspective\" \"float fov\" 60");
    EXPECT_NEAR(*camera.halfHeight, std::tan(M_PI / 6), 1e-9);
    EXPECT_NEAR(*camera.halfWidth, 2 * std::tan(M_PI / 6), 1e-9);
    const std::string tall =
        "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 200 ";
    EXPECT_NEAR(*cameraOf(tall + "Camera \"perspective\"").halfWidth, 1, 1e-9);
    EXPECT_NEAR(*cameraOf(tall + "Camera \"perspective\" \"float halffov\" 30").halfHeight,
                2 * std::tan(M_PI / 6), 1e-9);
}

TEST(PbrtCamera, HasAScreenWindow) {
    const FileCamera camera = cameraOf("Camera \"perspective\" \"float screenwindow\" [0 2 -1 1]");
    EXPECT_NEAR(*camera.halfWidth, 1, 1e-9);
    EXPECT_NEAR(camera.shift.x, 1, 1e-9);
    const FileCamera flat = cameraOf("Camera \"orthographic\" \"float screenwindow\" [0 4 0 2]");
    EXPECT_EQ(flat.projection, Projection::Orthographic);
    EXPECT_NEAR(*flat.halfWidth, 2, 1e-9);
    expectClose(flat.position, {2, 1, 0});
}

TEST(PbrtCamera, HasALens) {
    const FileCamera camera = cameraOf("Scale .5 .5 .5 Camera \"perspective\" \"float lensradius\" "
                                       ".1 \"float focaldistance\" 3");
    EXPECT_NEAR(camera.lensRadius, 0.2, 1e-9);
    EXPECT_NEAR(camera.focusDistance, 6, 1e-9);
}

TEST(PbrtCamera, OthersAreReplacedByAPerspectiveOne) {
    const std::string text = "Camera \"realistic\" WorldBegin " + std::string(kTriangle);
    EXPECT_EQ(loadText(text).cameras.size(), 1u);
    EXPECT_THAT(problemOf(text), HasSubstr("1: <Camera \"realistic\">: is no camera that is read"));
}

/// A scene of a lamp of the radiance 1 before such a camera; 36 mm x 24 mm of film.
Scene sceneThrough(const std::string& lens, const std::string& more, const char* film = "rgb") {
    return loadText(
        std::string("Film \"") + film +
        "\" \"integer xresolution\" 300 \"integer yresolution\" 200 \"float diagonal\" "
        "43.266615 Camera \"realistic\" \"float aperturediameter\" 10 \"string lensfile\" \"" +
        lens + "\" " + more + " WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] " +
        kTriangle);
}

double lightThrough(const Scene& scene) {
    return scene.materials.at(scene.triangles.at(0).material).emission.x;
}

TEST(PbrtRealisticCamera, IsThatOfAThinLens) {
    const std::string lens =
        writeFile("thin.dat", "# a thin lens\n0 0 0 20\n50 0 1.5 90\n-50 9 1 90\n")
            .filename()
            .string();
    const Scene scene = sceneThrough(lens, "\"float focusdistance\" 5");
    const FileCamera& camera = scene.cameras.at(0);
    // s + v = 5 and 1 / s + 1 / v = 1 / 0.05.
    const double v = (5 - std::sqrt(25 - 4 * 5 * 0.05)) / 2;
    EXPECT_NEAR(*camera.halfHeight, 0.012 / v, 1e-7);
    EXPECT_NEAR(*camera.halfWidth, 0.018 / v, 1e-7);
    EXPECT_NEAR(camera.focusDistance, 5 - v, 1e-9);
    EXPECT_NEAR(camera.lensRadius, 0.005, 1e-9);
    EXPECT_NEAR(camera.position.z, v, 1e-9);
    const double light = M_PI * 0.005 * 0.005 / (v * v);
    EXPECT_NEAR(lightThrough(scene), light, 1e-6 * light);
    const std::string v3 = "\"float focusdistance\" 5 \"bool simpleweighting\" ";
    EXPECT_DOUBLE_EQ(lightThrough(sceneThrough(lens, v3 + "\"true\"", "image")), 1);
    EXPECT_NEAR(lightThrough(sceneThrough(lens, v3 + "\"false\"", "image")), light, 1e-6 * light);
}

TEST(PbrtRealisticCamera, MayHaveSeveralElements) {
    // Two thin lenses, 100 and 50 mm, and the stop 20 mm apart: its image in the first is the
    // pupil.
    const std::string lens =
        writeFile("two.dat", "100, 0, 1.5, 90\n-100, 20, 1, 90\n0, 20, 0, 90\n50 0 1.5 90\n"
                             "-50 30 1 90\n")
            .filename()
            .string();
    const Scene scene = sceneThrough(lens, "\"float focusdistance\" 1e9");
    const FileCamera& camera = scene.cameras.at(0);
    const double focal = 0.1 * 0.05 / (0.1 + 0.05 - 0.04);
    EXPECT_NEAR(*camera.halfHeight, 0.012 / focal, 1e-6);
    // A stop 20 mm behind 100 mm seems 25 mm behind it, and 5 / 4 as wide.
    EXPECT_NEAR(camera.lensRadius, 0.005 * 1.25, 1e-9);
    const double behind = focal * (1 - 0.04 / 0.1);
    EXPECT_NEAR(camera.position.z, 0.04 + behind - 0.025, 1e-7);
    EXPECT_THAT(scene.report.forgiven, testing::Contains(HasSubstr("a thin lens of 45.5 mm")));
}

TEST(PbrtRealisticCamera, HasTheFocalLengthOfTheNameWithoutItsFile) {
    const Scene scene = sceneThrough("lenses/wide.22mm.dat", "\"float focusdistance\" 1e9");
    EXPECT_NEAR(*scene.cameras.at(0).halfHeight, 12.0 / 22, 1e-6);
    EXPECT_THAT(scene.report.forgiven, testing::Contains(HasSubstr("which is not there")));
}

RenderHints hintsOf(const std::string& before) {
    return loadText(before + " WorldBegin " + kTriangle).hints;
}

TEST(PbrtFilm, HasASizeAndAPart) {
    const RenderHints hints = hintsOf("Film \"image\" \"float cropwindow\" [.25 .5 0 .5]");
    EXPECT_EQ(hints.width, 1280u);
    EXPECT_EQ(hints.height, 720u);
    ASSERT_TRUE(hints.crop);
    EXPECT_EQ(*hints.crop, (std::array<uint32_t, 4>{320, 0, 320, 360}));
    const RenderHints pixels = hintsOf("Film \"rgb\" \"integer pixelbounds\" [10 30 20 60]");
    EXPECT_EQ(*pixels.crop, (std::array<uint32_t, 4>{10, 20, 20, 40}));
}

TEST(PbrtFilm, SaysHowBrightLightIs) {
    const auto emission = [](const std::string& before) {
        const Scene scene = loadText(
            before + " WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] " + kTriangle);
        return scene.materials.at(scene.triangles.at(0).material).emission.x;
    };
    EXPECT_FLOAT_EQ(emission("Film \"rgb\" \"float iso\" 200"), 2);
    EXPECT_FLOAT_EQ(emission("Film \"rgb\" \"float iso\" 200 Camera \"perspective\" \"float "
                             "shutterclose\" .25"),
                    0.5f);
    EXPECT_FLOAT_EQ(emission("Film \"image\" \"float scale\" 3 Camera \"perspective\" \"float "
                             "shutterclose\" .25"),
                    3);
}

TEST(PbrtFilm, SaysWhichOptionBalancesColors) {
    const Scene scene =
        loadText(std::string("Film \"rgb\" \"float whitebalance\" 5000 WorldBegin ") + kTriangle);
    EXPECT_THAT(scene.report.ignored, testing::Contains(HasSubstr("--white-balance 5000")));
}

TEST(PbrtFilter, OfEachVersionHasItsDefault) {
    EXPECT_EQ(hintsOf("Film \"image\"").filter, HintedFilter::Box);
    const RenderHints v4 = hintsOf("Film \"rgb\"");
    EXPECT_EQ(v4.filter, HintedFilter::Gaussian);
    EXPECT_EQ(v4.filterShape.deviation, 0.5);
    EXPECT_NEAR(
        hintsOf("Film \"image\" PixelFilter \"gaussian\" \"float alpha\" 8").filterShape.deviation,
        0.25, 1e-9);
    EXPECT_EQ(hintsOf("PixelFilter \"triangle\" \"float xradius\" 1").filterShape.radius, 1);
    EXPECT_EQ(hintsOf("PixelFilter \"mitchell\" \"float B\" .5").filterShape.b, 0.5);
    EXPECT_EQ(hintsOf("PixelFilter \"sinc\"").filter, HintedFilter::Lanczos);
}

TEST(PbrtIntegrator, SaysHowManyBounces) {
    EXPECT_EQ(hintsOf("").maxBounces, 5u);
    EXPECT_EQ(hintsOf("Integrator \"volpath\" \"integer maxdepth\" 12").maxBounces, 12u);
    const Scene scene = loadText(std::string("Integrator \"bdpt\" WorldBegin ") + kTriangle);
    EXPECT_THAT(scene.report.assumed, testing::Contains(HasSubstr("path takes its place")));
    EXPECT_THAT(problemOf(std::string("Integrator \"ao\" WorldBegin ") + kTriangle),
                HasSubstr("is no integrator that is read"));
}

TEST(PbrtTransforms, HaveAStackAndNames) {
    const Scene scene = loadV4("AttributeBegin Translate 5 0 0 CoordinateSystem \"there\" "
                               "AttributeEnd CoordSysTransform \"there\" " +
                               std::string(kTriangle));
    EXPECT_FLOAT_EQ(scene.bounds().lo.x, 5);
    const Scene camera = loadText("LookAt 0 0 -5 0 0 0 0 1 0 Camera \"perspective\" WorldBegin "
                                  "CoordSysTransform \"camera\" Translate 0 0 2 " +
                                  std::string(kTriangle));
    EXPECT_FLOAT_EQ(camera.bounds().lo.z, -3);
    EXPECT_THAT(problemInV4("CoordSysTransform \"nowhere\""), HasSubstr("which is not there"));
    EXPECT_THAT(problemInV4("AttributeEnd"), HasSubstr("ends what has not begun"));
}

TEST(PbrtTransforms, OfTheStartAreTaken) {
    const std::string world = "ActiveTransform EndTime Translate 9 0 0 ActiveTransform All "
                              "Translate 1 0 0 " +
                              std::string(kTriangle);
    EXPECT_FLOAT_EQ(loadV4(world).bounds().lo.x, 1);
    EXPECT_THAT(problemInV4(world), HasSubstr("<Shape>: moves"));
}

} // namespace
} // namespace stromboli::test
