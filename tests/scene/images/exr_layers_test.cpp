// Layers of OpenEXR files, and pictures of radiance as they are stored.
#include "host/core/error.hpp"
#include "scene/images/exr_channels.hpp"
#include "scene/images/float_image.hpp"
#include "scene/images/picture.hpp"
#include "tests/scene/images/encoders.hpp"

#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace stromboli::images {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kChannels = {"R",        "G",       "B",     "albedo.R", "albedo.G",
                                            "albedo.B", "depth.Z", "sky.Y", "A"};

/// A picture of one pixel, which is 1, 2, 3, ... in the order of the channels.
std::string layered(const std::function<void(Imf::Header&)>& change = {}) {
    return test::exr(1, 1, kChannels, {1, 2, 3, 4, 5, 6, 7, 8, 0.5f}, false, change);
}

std::vector<float> colorOf(const std::string& bytes, const std::string& layer) {
    return std::get<std::vector<float>>(decodeExrLayer(bytes, "a.exr", layer).picture.values);
}

std::string messageOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

RadiancePicture readFrom(const std::string& bytes, const std::string& layer = "") {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("stromboli_radiance_" + std::to_string(getpid()));
    std::ofstream(file, std::ios::binary) << bytes;
    RadiancePicture picture;
    const std::string message = messageOf([&] { picture = readRadiance(file, layer); });
    std::filesystem::remove(file);
    if (!message.empty()) throw SceneError(message);
    return picture;
}

TEST(ExrLayers, AreNamedByTheirChannels) {
    EXPECT_THAT(exrLayers(kChannels), ElementsAre("", "albedo", "sky"));
    EXPECT_FALSE(exrChannelsOf(kChannels, "depth"));
    EXPECT_FALSE(exrChannelsOf(kChannels, "Albedo"));
    EXPECT_EQ(exrChannelsOf(kChannels, "albedo")->color[1], "albedo.G");
    EXPECT_EQ(exrChannelsOf(kChannels, "")->alpha, "A");
}

TEST(ExrLayers, TheOneThatIsAskedForIsRead) {
    EXPECT_THAT(colorOf(layered(), ""), ElementsAre(1, 2, 3, 0.5f));
    EXPECT_THAT(colorOf(layered(), "albedo"), ElementsAre(4, 5, 6, 1));
    EXPECT_THAT(colorOf(layered(), "sky"), ElementsAre(8, 8, 8, 1));
}

TEST(ExrLayers, OneThatIsNotThereIsNamedWithThoseThatAre) {
    EXPECT_EQ(messageOf([] { decodeExrLayer(layered(), "a.exr", "depth"); }),
              "a.exr: cannot be read as OpenEXR: it has no layer 'depth' with colours, but albedo, "
              "sky");
}

/// As some programs write them: each layer is a part, whose channels have no other name.
TEST(ExrLayers, MayBeParts) {
    const auto named = [](Imf::Header& header) {
        header.setName("beauty");
        header.setType(Imf::SCANLINEIMAGE);
    };
    EXPECT_THAT(colorOf(layered(named), "beauty"), ElementsAre(1, 2, 3, 0.5f));
}

/// A compositor's picture is what is stored: no row is turned, and nothing is put around it.
TEST(Radiance, OfAPartSaysWhereItLies) {
    const std::string bytes =
        test::exr(2, 1, {"R", "G", "B"}, {1, 2, 3, 4, 5, 6}, false, [](Imf::Header& header) {
            header.displayWindow() = {{-3, -2}, {6, 7}};
            Imf::addEnvmap(header, Imf::ENVMAP_LATLONG);
        });
    const RadiancePicture picture = readFrom(bytes);
    EXPECT_EQ(picture.width, 2u);
    EXPECT_EQ(picture.height, 1u);
    EXPECT_EQ(picture.left, 3u);
    EXPECT_EQ(picture.top, 2u);
    EXPECT_EQ(picture.wholeWidth, 10u);
    EXPECT_EQ(picture.wholeHeight, 10u);
    EXPECT_EQ(picture.texels[0], glm::vec4(1, 2, 3, 1));
    EXPECT_EQ(picture.texels[1], glm::vec4(4, 5, 6, 1));
    EXPECT_FALSE(picture.isTransparent());
}

/// Files of floats multiply colours by alpha, those of whole numbers do not.
TEST(Radiance, IsMultipliedByAlpha) {
    const RadiancePicture floats = readFrom(layered());
    EXPECT_EQ(floats.texels[0], glm::vec4(1, 2, 3, 0.5f));
    EXPECT_TRUE(floats.isTransparent());
    const RadiancePicture bytes =
        readFrom(test::png8(2, 1, 4, {255, 0, 255, 51, 255, 255, 255, 255}));
    EXPECT_EQ(bytes.texels[0], glm::vec4(0.2f, 0, 0.2f, 0.2f));
    EXPECT_EQ(bytes.texels[1], glm::vec4(1));
    EXPECT_TRUE(bytes.isTransparent());
    EXPECT_FALSE(readFrom(test::png16(1, 1, 3, {65535, 0, 65535})).isTransparent());
}

TEST(Radiance, OnlyOpenExrHasLayers) {
    EXPECT_THAT(messageOf([] {
                    readFrom(test::png8(1, 1, 3, {1, 2, 3}), "albedo");
                }),
                HasSubstr("has no layers: only OpenEXR files have them"));
}

} // namespace
} // namespace stromboli::images
