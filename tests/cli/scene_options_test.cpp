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

TEST(SceneOptions, ViewsAndLenses) {
    const CameraRequest camera =
        parse<InfoOptions>({"info", "a.dae", "--look-from", "1", "-2", "3e1", "--look-at", "0",
                            "0.5", "0", "--fov", "90", "--aperture", "5mm", "--focus", "2.5"})
            .picture.camera;
    EXPECT_EQ(camera.from, glm::dvec3(1, -2, 30));
    EXPECT_EQ(camera.at, glm::dvec3(0, 0.5, 0));
    EXPECT_DOUBLE_EQ(camera.fieldOfView.value(), std::acos(0.0));
    EXPECT_DOUBLE_EQ(camera.aperture, 0.005);
    EXPECT_DOUBLE_EQ(camera.focus, 2.5);
    EXPECT_DOUBLE_EQ(parse<InfoOptions>({"info", "a.dae", "--aperture", "1cm", "--focus", "0.1km"})
                         .picture.camera.focus,
                     100);
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
