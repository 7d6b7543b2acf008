// Cameras, films and what integrators say.

#include "scene/camera/camera.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

Scene sceneSeenBy(const std::string& inside, const std::string& type = "perspective") {
    return loadInside(fmt::format("<sensor type=\"{}\">{}</sensor>", type, inside));
}

const std::string kWideFilm = "<film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/>"
                              "<integer name=\"height\" value=\"100\"/></film>";

TEST(MitsubaSensors, LookAlongZWithXToTheLeft) {
    const FileCamera camera = sceneSeenBy("").cameras.at(0);
    EXPECT_EQ(camera.back, glm::dvec3(0, 0, -1));
    EXPECT_EQ(camera.right, glm::dvec3(-1, 0, 0));
    EXPECT_EQ(camera.up, glm::dvec3(0, 1, 0));
}

/// A scale of -1 along x turns left and right round.
TEST(MitsubaSensors, MayShowMirrorImages) {
    const FileCamera camera =
        sceneSeenBy("<transform name=\"to_world\"><scale x=\"-1\"/></transform>").cameras.at(0);
    EXPECT_EQ(camera.back, glm::dvec3(0, 0, -1));
    EXPECT_EQ(camera.right, glm::dvec3(1, 0, 0));
    EXPECT_EQ(camera.up, glm::dvec3(0, 1, 0));
}

/// The diagonal of 36 x 24 mm at 50 mm: 34.02 degrees across a square.
TEST(MitsubaSensors, TheStandardLensHas50Millimetres) {
    const FileCamera square =
        sceneSeenBy("<film type=\"hdrfilm\"><integer name=\"width\" value=\"8\"/>"
                    "<integer name=\"height\" value=\"8\"/></film>")
            .cameras.at(0);
    EXPECT_NEAR(2 * std::atan(*square.halfWidth) * 180 / M_PI, 34.0224, 1e-3);
    EXPECT_EQ(square.halfWidth, square.halfHeight);
}

TEST(MitsubaSensors, AnglesBelongToAnAxis) {
    const auto widthOf = [](const std::string& axis) {
        const std::string stated =
            axis.empty() ? "" : "<string name=\"fov_axis\" value=\"" + axis + "\"/>";
        return *sceneSeenBy("<float name=\"fov\" value=\"90\"/>" + stated + kWideFilm)
                    .cameras.at(0)
                    .halfWidth;
    };
    EXPECT_NEAR(widthOf(""), 1, 1e-12);
    EXPECT_NEAR(widthOf("larger"), 1, 1e-12);
    EXPECT_NEAR(widthOf("y"), 2, 1e-12);
    EXPECT_NEAR(widthOf("smaller"), 2, 1e-12);
    EXPECT_NEAR(widthOf("diagonal"), 2 / std::sqrt(5.0), 1e-12);
    EXPECT_THAT(problemInside("<sensor type=\"perspective\"><float name=\"fov\" value=\"90\"/>"
                              "<string name=\"fov_axis\" value=\"z\"/></sensor>"),
                HasSubstr("'fov_axis' is 'z', expected x, y, diagonal, smaller or larger"));
}

/// A fifth of the picture's width to the right, a tenth of its height down, as Mitsuba 3.9's
/// sample_ray has it; its lenses have no such offsets.
TEST(MitsubaSensors, PrincipalPointsMove) {
    const std::string offsets = "<float name=\"principal_point_offset_x\" value=\"0.2\"/>"
                                "<float name=\"principal_point_offset_y\" value=\"0.1\"/>";
    const Scene scene = sceneSeenBy("<float name=\"fov\" value=\"60\"/>" + offsets + kWideFilm);
    const Camera camera = makeCamera(scene, CameraChoice::File, 200, 100);
    EXPECT_NEAR(camera.shift.x, 0.2309401, 1e-6);
    EXPECT_NEAR(camera.shift.y, -0.0577350, 1e-6);
    EXPECT_THAT(problemInside("<sensor type=\"thinlens\">" + offsets + "</sensor>"),
                HasSubstr("'principal_point_offset_x' is not read in sensor 'thinlens'"));
}

TEST(MitsubaSensors, LensesAndParallelViews) {
    const FileCamera lens = sceneSeenBy("<float name=\"aperture_radius\" value=\"0.2\"/>"
                                        "<float name=\"focus_distance\" value=\"7\"/>",
                                        "thinlens")
                                .cameras.at(0);
    EXPECT_EQ(lens.lensRadius, 0.2);
    EXPECT_EQ(lens.focusDistance, 7);
    const Scene parallel =
        sceneSeenBy("<transform name=\"to_world\"><scale x=\"3\" y=\"3\"/></transform>" + kWideFilm,
                    "orthographic");
    EXPECT_EQ(*parallel.cameras.at(0).halfWidth, 3);
    EXPECT_EQ(*parallel.cameras.at(0).halfHeight, 1.5);
    EXPECT_TRUE(parallel.report.warnings.empty()) << "it has no length along the view";
    EXPECT_FALSE(
        sceneSeenBy("<transform name=\"to_world\"><scale x=\"3\" y=\"2\"/></transform>" + kWideFilm,
                    "orthographic")
            .report.warnings.empty());
    const Camera camera =
        makeCamera(sceneSeenBy("<float name=\"aperture_radius\" value=\"0.2\"/>", "thinlens"),
                   CameraChoice::File, 100, 75);
    EXPECT_EQ(camera.lensRadius, 0.2);
}

TEST(MitsubaSensors, FilmsAreHints) {
    const Scene scene = sceneSeenBy("<film type=\"hdrfilm\"><integer name=\"width\" value=\"200\"/>"
                                    "<integer name=\"height\" value=\"100\"/>"
                                    "<rfilter type=\"box\"/></film>");
    EXPECT_EQ(scene.hints.width, 200u);
    EXPECT_EQ(scene.hints.filter, HintedFilter::Box);
    EXPECT_EQ(defaultPictureSize(scene, {}).height, 100u);
    EXPECT_EQ(sceneSeenBy(kWideFilm).hints.filter, HintedFilter::Gaussian);
    EXPECT_FALSE(loadInside("").hints.filter);
}

TEST(MitsubaSensors, FiltersHaveTheirNumbers) {
    const auto hintsOf = [](const std::string& filter) {
        return sceneSeenBy("<film type=\"hdrfilm\"><rfilter " + filter + "</rfilter></film>").hints;
    };
    const RenderHints tent = hintsOf("type=\"tent\"><float name=\"radius\" value=\"1.5\"/>");
    EXPECT_EQ(tent.filter, HintedFilter::Tent);
    EXPECT_EQ(tent.filterShape.radius, 1.5);
    const RenderHints gaussian =
        hintsOf("type=\"gaussian\"><float name=\"stddev\" value=\"0.7\"/>");
    EXPECT_EQ(gaussian.filter, HintedFilter::Gaussian);
    EXPECT_EQ(gaussian.filterShape.deviation, 0.7);
    const RenderHints mitchell = hintsOf("type=\"mitchell\"><float name=\"B\" value=\"0.2\"/>"
                                         "<float name=\"C\" value=\"0.4\"/>");
    EXPECT_EQ(mitchell.filter, HintedFilter::Mitchell);
    EXPECT_EQ(mitchell.filterShape.b, 0.2);
    EXPECT_EQ(mitchell.filterShape.c, 0.4);
    EXPECT_EQ(hintsOf("type=\"catmullrom\">").filter, HintedFilter::CatmullRom);
    const RenderHints lanczos = hintsOf("type=\"lanczos\"><integer name=\"lobes\" value=\"2\"/>");
    EXPECT_EQ(lanczos.filter, HintedFilter::Lanczos);
    EXPECT_EQ(lanczos.filterShape.lobes, 2u);
    const auto problemOf = [](const std::string& filter) {
        return problemInside("<sensor type=\"perspective\"><film type=\"hdrfilm\"><rfilter " +
                             filter + "</rfilter></film></sensor>");
    };
    EXPECT_THAT(problemOf("type=\"lanczos\"><integer name=\"lobes\" value=\"0\"/>"),
                HasSubstr("'lobes' is 0, expected 1 to 64"));
    EXPECT_THAT(problemOf("type=\"tent\"><float name=\"radius\" value=\"0\"/>"),
                HasSubstr("'radius' is 0, expected more"));
    EXPECT_THAT(problemOf("type=\"sinc\">"), HasSubstr("'sinc' is no filter that is read"));
    EXPECT_THAT(problemOf("type=\"box\"><float name=\"radius\" value=\"2\"/>"),
                HasSubstr("'radius' is not read in rfilter 'box'"));
}

TEST(MitsubaSensors, DepthsCountSegments) {
    const auto bouncesOf = [](const std::string& inside, const std::string& type = "path") {
        return loadInside("<integrator type=\"" + type + "\">" + inside + "</integrator>")
            .hints.maxBounces;
    };
    EXPECT_EQ(bouncesOf("<integer name=\"max_depth\" value=\"2\"/>"), 1u);
    EXPECT_EQ(bouncesOf("<integer name=\"max_depth\" value=\"1\"/>"), 0u);
    EXPECT_EQ(bouncesOf(""), 10000u);
    EXPECT_EQ(bouncesOf("", "direct"), 1u);
    EXPECT_EQ(bouncesOf("<integrator type=\"direct\"/>", "moment"), 1u);
    EXPECT_THAT(problemInside("<integrator type=\"rasterizer\"/>"),
                HasSubstr("'rasterizer' is no integrator that is read"));
}

TEST(MitsubaSensors, RouletteBeginsWhereTheFileSays) {
    const auto startOf = [](const std::string& inside) {
        return loadInside("<integrator type=\"path\">" + inside + "</integrator>")
            .hints.rouletteStart;
    };
    EXPECT_FALSE(startOf(""));
    EXPECT_EQ(startOf("<integer name=\"rr_depth\" value=\"7\"/>"), 7u);
    EXPECT_THAT(problemInside("<integrator type=\"path\"><integer name=\"rr_depth\" "
                              "value=\"0\"/></integrator>"),
                HasSubstr("'rr_depth' is 0, expected 1 or more"));
}

TEST(MitsubaSensors, DepthsArePicturesOfDistances) {
    EXPECT_TRUE(loadInside("<integrator type=\"depth\"/>").hints.showsDepth);
    EXPECT_FALSE(loadInside("<integrator type=\"path\"/>").hints.showsDepth);
}

TEST(MitsubaSensors, EmittersMayBeHidden) {
    const auto load = [](const std::string& value) {
        return loadInside("<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"" +
                          value +
                          "\"/></integrator><shape type=\"rectangle\"><emitter type=\"area\"/>"
                          "</shape><shape type=\"sphere\"/>");
    };
    const Scene hidden = load("true"), shown = load("false");
    EXPECT_TRUE(hidden.hints.hidesBackdrop);
    EXPECT_FALSE(shown.hints.hidesBackdrop);
    const auto hiddenMaterials = [](const Scene& scene) {
        std::vector<bool> all;
        for (const Triangle& t : scene.triangles)
            all.push_back(scene.materials[t.material].isHiddenFromCamera);
        for (const Sphere& s : scene.spheres)
            all.push_back(scene.materials[s.material].isHiddenFromCamera);
        return all;
    };
    EXPECT_EQ(hiddenMaterials(hidden), (std::vector<bool>{true, true, false}));
    EXPECT_EQ(hiddenMaterials(shown), (std::vector<bool>{false, false, false}));
}

TEST(MitsubaSensors, FilmsMayBeCropped) {
    const auto film = [](const std::string& inside) {
        return "<sensor type=\"perspective\"><film type=\"hdrfilm\"><integer name=\"width\" "
               "value=\"40\"/><integer name=\"height\" value=\"30\"/>" +
               inside + "</film></sensor>";
    };
    EXPECT_FALSE(loadInside(film("")).hints.crop.has_value());
    const Scene scene = loadInside(film("<integer name=\"crop_offset_x\" value=\"5\"/>"
                                        "<integer name=\"crop_width\" value=\"10\"/>"));
    EXPECT_EQ(scene.hints.crop.value(), (std::array<uint32_t, 4>{5, 0, 10, 30}));
    EXPECT_THAT(problemInside(film("<integer name=\"crop_offset_x\" value=\"35\"/>"
                                   "<integer name=\"crop_width\" value=\"10\"/>")),
                HasSubstr("is 10, expected 1 to 5"));
}

TEST(MitsubaSensors, ClipsAreTheCameras) {
    const Scene scene =
        loadInside("<sensor type=\"perspective\"><float name=\"near_clip\" value=\"2\"/>"
                   "<float name=\"far_clip\" value=\"50\"/></sensor>");
    EXPECT_EQ(scene.cameras.at(0).nearDistance, 2);
    EXPECT_EQ(scene.cameras.at(0).farDistance, 50);
    EXPECT_THAT(problemInside("<sensor type=\"perspective\"><float name=\"near_clip\" value=\"2\"/>"
                              "<float name=\"far_clip\" value=\"1\"/></sensor>"),
                HasSubstr("is not more than near_clip"));
}

} // namespace
} // namespace stromboli::test
