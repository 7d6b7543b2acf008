// An environment that a user asks for takes the place of what a file says of the sky.
#include "scene/add_environment.hpp"

#include "host/core/error.hpp"

#include <glm/gtc/constants.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A Radiance picture of 2 x 1 texels, (1, 0.5, 0.25) and (4, 4, 4), without compression: a byte
/// b with the exponent e is b 2^(e - 136).
std::filesystem::path smallPicture() {
    const auto file = std::filesystem::temp_directory_path() / "stromboli_add_environment.hdr";
    std::ofstream out(file, std::ios::binary);
    out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n";
    const unsigned char texels[8] = {128, 64, 32, 129, 128, 128, 128, 131};
    out.write(reinterpret_cast<const char*>(texels), sizeof texels);
    return file;
}

TEST(AddEnvironment, ReadsThePicture) {
    EnvironmentRequest request;
    request.file = smallPicture().string();
    request.rotationDegrees = 180;
    request.strength = 2;
    Scene scene;
    addEnvironment(scene, request);
    ASSERT_TRUE(scene.environment);
    const Environment& e = *scene.environment;
    EXPECT_EQ(e.width, 2u);
    EXPECT_EQ(e.height, 1u);
    EXPECT_THAT(e.radiance, ElementsAre(glm::vec3(1, 0.5f, 0.25f), glm::vec3(4)));
    EXPECT_FLOAT_EQ(e.rotation, 3.14159265f);
    EXPECT_EQ(e.strength, 2);
    EXPECT_FALSE(e.isConstant());
    std::filesystem::remove(request.file);
}

TEST(AddEnvironment, TakesThePlaceOfAmbientLightAndSaysSo) {
    Scene scene;
    scene.lights.resize(3);
    scene.lights[0].kind = scene.lights[2].kind = LightKind::Ambient;
    EnvironmentRequest request;
    request.constant = glm::vec3(1, 2, 3);
    addEnvironment(scene, request);
    EXPECT_TRUE(scene.environment->isConstant());
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_THAT(scene.report.assumed, ElementsAre(HasSubstr("2 ambient lights")));
}

TEST(AddEnvironment, BundledPicturesGoByTheirNames) {
    EnvironmentRequest request;
    request.file = "evening_sky";
    Scene scene;
    addEnvironment(scene, request);
    ASSERT_TRUE(scene.environment);
    const Environment& sky = *scene.environment;
    EXPECT_EQ(sky.width, 256u);
    EXPECT_EQ(sky.height, 128u);
    // A sun of some hundreds of times the sky's radiance, above the horizon, on the left of -z.
    const auto sun =
        std::ranges::max_element(sky.radiance, {}, [](const glm::vec3& c) { return c.x; });
    const size_t place = size_t(sun - sky.radiance.begin());
    EXPECT_GT(sun->x, 200);
    EXPECT_LT(place / sky.width, sky.height / 2);
    EXPECT_LT(place % sky.width, sky.width / 2);
}

TEST(AddEnvironment, OthersThanTheSkyAreBundledToo) {
    for (const char* name : {"studio", "overcast", "interior"}) {
        EnvironmentRequest request;
        request.file = name;
        Scene scene;
        addEnvironment(scene, request);
        EXPECT_EQ(scene.environment->width, 256u) << name;
    }
}

/// What a picture of a sky brings to the ground: the radiance of white paper there.
glm::dvec3 paperUnder(const Environment& sky) {
    glm::dvec3 sum(0.0);
    const double step = glm::pi<double>() / sky.height;
    for (size_t texel = 0; texel < sky.radiance.size(); ++texel) {
        const double down = (double(texel / sky.width) + 0.5) * step;
        if (down < glm::half_pi<double>())
            sum += glm::dvec3(sky.radiance[texel]) * std::cos(down) * std::sin(down);
    }
    return sum * step * glm::two_pi<double>() / double(sky.width) / glm::pi<double>();
}

TEST(AddEnvironment, ASunIsWhereItIsAskedForAndLightsTheGround) {
    EnvironmentRequest request;
    request.sun = SunRequest{};
    Scene scene;
    addEnvironment(scene, request);
    const glm::dvec3 paper = paperUnder(*scene.environment);
    EXPECT_NEAR(0.2126 * paper.x + 0.7152 * paper.y + 0.0722 * paper.z, 1, 0.01);
    // The ground around reflects 30 %.
    const glm::vec3 below = scene.environment->radiance.back();
    EXPECT_NEAR(below.y, 0.3 * paper.y, 0.002);
    request.sun = SunRequest{90, 30, 5}; // the east: +x
    addEnvironment(scene, request);
    const Environment& sky = *scene.environment;
    const auto sun =
        std::ranges::max_element(sky.radiance, {}, [](const glm::vec3& c) { return c.x; });
    const auto place = size_t(sun - sky.radiance.begin());
    // In the middle, -z, from where the rotation takes it clockwise to +x.
    EXPECT_NEAR(double(place % sky.width) / sky.width, 0.5, 0.003);
    EXPECT_FLOAT_EQ(sky.rotation, -1.57079633f);
    EXPECT_NEAR(90 - double(place / sky.width) * 180 / sky.height, 30, 0.5);
}

TEST(AddEnvironment, UnknownNamesAreOneErrorThatNamesTheBundledOnes) {
    EnvironmentRequest request;
    request.file = "evening_ski";
    Scene scene;
    try {
        addEnvironment(scene, request);
        ADD_FAILURE();
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(),
                    testing::AllOf(HasSubstr("evening_ski"), HasSubstr("evening_sky")));
    }
}

TEST(AddEnvironment, AFileThatIsNoPictureIsNamed) {
    EnvironmentRequest request;
    request.file = "/nowhere/sky.hdr";
    Scene scene;
    try {
        addEnvironment(scene, request);
        ADD_FAILURE();
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), HasSubstr("/nowhere/sky.hdr"));
    }
}

} // namespace
} // namespace stromboli::test
