// What the command line says of the scene: which of its cameras, which light, how its file is read.
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "tests/cli/parse.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using test::parse;

TEST(SceneOptions, OtherWordsNameACameraOfTheFile) {
    const auto camera = [](const char* word) {
        return parse<InfoOptions>({"info", "a.dae", "--camera", word}).picture.camera;
    };
    EXPECT_EQ(camera("2").choice, CameraChoice::File);
    EXPECT_EQ(camera("2").name, "2");
    EXPECT_EQ(camera("left eye").name, "left eye");
    EXPECT_EQ(camera("file").name, "");
}

TEST(SceneOptions, TheLightAroundTheScene) {
    const auto environment = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"info", "a.dae"});
        return parse<InfoOptions>(words).scene.environment;
    };
    EXPECT_FALSE(environment({}).isGiven());
    EXPECT_EQ(environment({"--env", "sky.hdr"}).file, "sky.hdr");
    EXPECT_EQ(environment({"--env", "0.5"}).constant, glm::vec3(0.5f));
    EXPECT_EQ(environment({"--env", "1,0.5,2e1"}).constant, glm::vec3(1, 0.5f, 20));
    EXPECT_EQ(environment({"--env", "1,2"}).file, "1,2"); // no radiance: a name
    EXPECT_EQ(environment({"--env", "-1"}).file, "-1");
    const EnvironmentRequest turned =
        environment({"--env", "sky.hdr", "--env-rotate", "90", "--env-strength", "2"});
    EXPECT_EQ(turned.rotationDegrees, 90);
    EXPECT_EQ(turned.strength, 2);
}

TEST(SceneOptions, FogInTheScene) {
    const auto fog = [](const std::string& word) {
        return parse<InfoOptions>({"info", "a.dae", "--fog", word}).scene.fog;
    };
    EXPECT_FALSE(parse<InfoOptions>({"info", "a.dae"}).scene.fog.isGiven());
    EXPECT_EQ(fog("0.5").density, 0.5);
    EXPECT_EQ(fog("0.5").color, glm::vec3(1));
    EXPECT_EQ(fog("0.5,-0.25").asymmetry, -0.25);
    EXPECT_EQ(fog("0.5,1,0.5,0").color, glm::vec3(1, 0.5f, 0));
    EXPECT_EQ(fog("0.5,1,0.5,0,0.75").asymmetry, 0.75);
    for (const char* wrong :
         {"", "thick", "-1", "1,2", "1,0.5,0.5", "1,2,0,0", "1,1,1,1,1,1", "1,"})
        EXPECT_THROW(fog(wrong), UsageError) << wrong;
}

TEST(SceneOptions, ASunAndAGround) {
    const auto scene = [](const std::vector<std::string>& words) {
        std::vector<std::string> all = {"info", "a.dae"};
        all.insert(all.end(), words.begin(), words.end());
        return parse<InfoOptions>(all).scene;
    };
    EXPECT_FALSE(scene({}).environment.sun);
    EXPECT_FALSE(scene({}).ground.isGiven);
    const SunRequest sun = *scene({"--sun", "135,40"}).environment.sun;
    EXPECT_EQ(sun.azimuth, 135);
    EXPECT_EQ(sun.elevation, 40);
    EXPECT_EQ(sun.turbidity, SunRequest{}.turbidity);
    EXPECT_EQ(scene({"--sun", "-20,0,7"}).environment.sun->turbidity, 7);
    for (const char* wrong : {"", "45", "0,91", "0,-1", "0,45,11", "0,45,3,1", "east,45"})
        EXPECT_THROW(scene({"--sun", wrong}), UsageError) << wrong;
    EXPECT_THROW(scene({"--sun", "0,45", "--env", "1"}), UsageError);
    EXPECT_EQ(scene({"--ground", "on"}).ground.color, GroundRequest{}.color);
    EXPECT_EQ(scene({"--ground", "0.25"}).ground.color, glm::vec3(0.25f));
    EXPECT_EQ(scene({"--ground", "0,0.5,1"}).ground.color, glm::vec3(0, 0.5f, 1));
    for (const char* wrong : {"", "off", "1.5", "0,0.5"})
        EXPECT_THROW(scene({"--ground", wrong}), UsageError) << wrong;
}

/// What a preset sets is what is not given, and it is part of the command that pictures note.
TEST(SceneOptions, PresetsSetWhatIsNotGiven) {
    const auto render = [](const std::vector<std::string>& words) {
        std::vector<std::string> all = {"render", "a.glb"};
        all.insert(all.end(), words.begin(), words.end());
        return parse<RenderOptions>(all);
    };
    const RenderOptions product = render({"-o", "a.png", "--preset", "product"});
    EXPECT_EQ(product.scene.environment.file, "studio");
    EXPECT_EQ(product.picture.denoiser, Denoiser::On);
    EXPECT_NE(std::ranges::find(product.command, "--env studio"), product.command.end());
    const RenderOptions given =
        render({"-o", "a.exr", "--preset", "product", "--sun", "0,45", "--denoise", "off"});
    EXPECT_TRUE(given.scene.environment.file.empty());
    EXPECT_EQ(given.picture.denoiser, Denoiser::Off);
    EXPECT_EQ(std::ranges::find(given.command, "--view pbr-neutral"), given.command.end())
        << "a file of radiance has no view";
    EXPECT_EQ(render({"-o", "a.png", "--preset", "draft"}).picture.budget.pathsPerPixel(), 8u);
    EXPECT_EQ(
        render({"-o", "a.png", "--preset", "draft", "--time", "9"}).picture.budget.stop.seconds, 9);
    EXPECT_THROW(render({"-o", "a.png", "--preset", "best"}), UsageError);
    // What does not go with an option that is given is not set.
    EXPECT_EQ(render({"-o", "a.png", "--preset", "final", "--even"}).picture.budget.stop.noise, 0);
    EXPECT_TRUE(render({"-o", "a.png", "--preset", "product", "--fog", "1"}).scene.fog.isGiven());
    const RenderOptions share =
        render({"-o", "a.film", "--preset", "product", "--share", "1/4", "-s", "512"});
    EXPECT_EQ(share.picture.denoiser, Denoiser::Off);
    EXPECT_EQ(share.scene.environment.file, "studio");
}

TEST(SceneOptions, ShadowsAreInAlphaOrOnABackground) {
    const auto catcher =
        parse<RenderOptions>({"render", "a.glb", "--shadow-catcher", "-o", "a.png"});
    EXPECT_TRUE(catcher.scene.ground.isGiven);
    EXPECT_EQ(catcher.picture.shadowCatcher, "ground");
    EXPECT_TRUE(catcher.picture.transparent);
    const auto table = parse<RenderOptions>(
        {"render", "a.glb", "--shadows-on", "table", "--background", "0.5", "-o", "a.jpg"});
    EXPECT_FALSE(table.scene.ground.isGiven);
    EXPECT_EQ(table.picture.shadowCatcher, "table");
    EXPECT_FALSE(table.picture.transparent);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"render", "a.glb", "--shadow-catcher", "-o", "a.jpg"},
          {"render", "a.glb", "--shadow-catcher", "--share", "1/2", "-o", "a.film"},
          {"submit", "slurm", "a.glb", "--shadow-catcher", "--shares", "4", "-o", "a.png"},
          {"submit", "slurm", "a.glb", "--background", "1", "--shares", "4", "-o", "a.png"}})
        EXPECT_THROW(parse<RenderOptions>(words), UsageError) << words[0] << ' ' << words[2];
}

TEST(SceneOptions, ViewsAndLenses) {
    const CameraRequest camera =
        parse<InfoOptions>({"info", "a.dae", "--look-from", "1", "-2", "3e1", "--look-at", "0",
                            "0.5", "0", "--fov", "90", "--aperture", "5mm", "--focus", "2.5"})
            .picture.camera;
    EXPECT_EQ(camera.from, glm::dvec3(1, -2, 30));
    EXPECT_EQ(camera.at, glm::dvec3(0, 0.5, 0));
    EXPECT_DOUBLE_EQ(camera.fieldOfView.value(), std::acos(0.0));
    EXPECT_DOUBLE_EQ(camera.aperture, 0.005);
    EXPECT_DOUBLE_EQ(camera.focus->distance, 2.5);
    EXPECT_DOUBLE_EQ(parse<InfoOptions>({"info", "a.dae", "--aperture", "1cm", "--focus", "0.1km"})
                         .picture.camera.focus->distance,
                     100);
}

TEST(SceneOptions, WhatALensMakesSharp) {
    const auto focus = [](std::vector<std::string> words) {
        words.insert(words.begin(), {"info", "--aperture", "5mm"});
        const InfoOptions o = parse<InfoOptions>(words);
        EXPECT_EQ(o.scene.source, "a.dae");
        return o.picture.camera.focus;
    };
    EXPECT_FALSE(focus({"a.dae"}).has_value());
    EXPECT_EQ(focus({"--focus", "auto", "a.dae"})->on, Focus::On::Middle);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"--focus", "320", "180", "a.dae"},
          {"a.dae", "--focus", "320,180"}}) {
        const std::optional<Focus> pixel = focus(words);
        EXPECT_EQ(pixel->on, Focus::On::Pixel);
        EXPECT_EQ(pixel->pixel, glm::dvec2(320, 180));
    }
    EXPECT_EQ(focus({"--focus", "3", "a.dae"})->distance, 3) << "one number is a distance";
}

TEST(SceneOptions, HowFilesAreRead) {
    const auto reading = [](std::vector<std::string> extra) {
        extra.insert(extra.begin(), {"check", "a.dae"});
        return parse<CheckOptions>(extra).scene.reading;
    };
    EXPECT_TRUE(reading({}).defaultLight);
    EXPECT_FALSE(reading({}).strict);
    EXPECT_FALSE(reading({"--default-light", "off"}).defaultLight);
    EXPECT_TRUE(reading({"--strict"}).strict);
    // That renderer has no such light, unless it is asked for, wherever the option stands.
    EXPECT_FALSE(reading({"--cs184"}).defaultLight);
    EXPECT_TRUE(reading({"--cs184", "--default-light", "on"}).defaultLight);
    EXPECT_TRUE(reading({"--default-light", "on", "--cs184", "--strict"}).defaultLight);
}

TEST(SceneOptions, WhatOfAFileIsShown) {
    const auto selection = [](std::vector<std::string> extra) {
        extra.insert(extra.begin(), {"info", "a.glb"});
        return parse<InfoOptions>(extra).scene.reading.selection;
    };
    EXPECT_FALSE(selection({}).scene.has_value());
    EXPECT_FALSE(selection({}).seconds.has_value());
    EXPECT_EQ(selection({}).option(), "");
    EXPECT_EQ(selection({"--scene", "0"}).scene, 0u);
    EXPECT_EQ(selection({"--variant", "night"}).variant, "night");
    EXPECT_EQ(selection({"--at", "1.5"}).seconds, 1.5);
    EXPECT_EQ(selection({"--max-texture", "512"}).largestTexture, 512u);
    EXPECT_EQ(selection({"--at", "0", "--cs184"}).seconds, 0); // wherever the option stands
}

TEST(SceneOptions, ValuesOfNamesInAScene) {
    const InfoOptions o =
        parse<InfoOptions>({"info", "a.xml", "-D", "spp=4", "--define", "file=a=b"});
    ASSERT_EQ(o.scene.reading.selection.definitions.size(), 2u);
    EXPECT_EQ(o.scene.reading.selection.definitions[0].name, "spp");
    EXPECT_EQ(o.scene.reading.selection.definitions[1].value, "a=b");
    EXPECT_THROW(parse<InfoOptions>({"info", "a.xml", "-D", "spp"}), UsageError);
    EXPECT_THROW(parse<InfoOptions>({"info", "a.xml", "-D", "=4"}), UsageError);
}

TEST(SceneOptions, WhatASceneFileMayAskForIsKnownToBeGiven) {
    const LeftToFile all = parse({"render", "a.xml", "-o", "a.png"}).picture.leftToFile;
    EXPECT_TRUE(all.bounces && all.filter && all.integrator);
    const LeftToFile less =
        parse({"render", "a.xml", "-o", "a.png", "-m", "3", "--filter", "box"}).picture.leftToFile;
    EXPECT_FALSE(less.bounces || less.filter);
}

TEST(SceneOptions, HowInstancesAreHeld) {
    const auto instances = [](const std::vector<std::string>& words) {
        std::vector<std::string> all = {"info", "a.dae"};
        all.insert(all.end(), words.begin(), words.end());
        return parse<InfoOptions>(all).scene.reading.instances;
    };
    EXPECT_EQ(instances({}), InstanceSharing::Automatic);
    EXPECT_EQ(instances({"--instances", "on"}), InstanceSharing::On);
    EXPECT_EQ(instances({"--instances", "off"}), InstanceSharing::Off);
    EXPECT_THROW(instances({"--instances", "many"}), UsageError);
}

} // namespace
} // namespace stromboli
