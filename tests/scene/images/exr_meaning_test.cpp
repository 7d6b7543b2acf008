// What an OpenEXR header says of colours and directions, with answers in closed form.
#include "scene/images/float_image.hpp"
#include "tests/scene/images/encoders.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfEnvmap.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace stromboli::images {
namespace {

FloatImage read(const std::string& bytes) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("stromboli_exr_" + std::to_string(getpid()) + ".exr");
    std::ofstream(file, std::ios::binary) << bytes;
    FloatImage image = readFloatImage(file);
    std::filesystem::remove(file);
    return image;
}

void expectNear(const glm::vec3& found, const glm::vec3& expected) {
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-4f) << "channel " << i;
}

/// Primaries that are those of Rec. 709 in another order permute the channels.
TEST(ExrMeaning, ChromaticitiesNameThePrimaries) {
    const Imf::Chromaticities own;
    const std::string bytes =
        test::exr(1, 1, {"R", "G", "B"}, {0.25f, 0.5f, 2}, false, [&](Imf::Header& header) {
            Imf::addChromaticities(header, {own.green, own.blue, own.red, own.white});
        });
    expectNear(read(bytes).texels.at(0), {2, 0.25f, 0.5f});
}

/// White stays white under another white point, and no other colour is grey then.
TEST(ExrMeaning, WhiteStaysWhite) {
    const Imf::Chromaticities own;
    const auto withWhite = [&](std::vector<float> color) {
        return read(test::exr(1, 1, {"R", "G", "B"}, std::move(color), false,
                              [&](Imf::Header& header) {
                                  Imf::addChromaticities(header, {own.red, own.green, own.blue,
                                                                  Imath::V2f(1 / 3.f, 1 / 3.f)});
                              }))
            .texels.at(0);
    };
    expectNear(withWhite({0.5f, 0.5f, 0.5f}), {0.5f, 0.5f, 0.5f});
    EXPECT_GT(withWhite({1, 0.25f, 0.25f}).x, 2 * withWhite({1, 0.25f, 0.25f}).z);
}

/// Y = 0.2126 R + 0.7152 G + 0.0722 B; the chroma channels are (R - Y) / Y and (B - Y) / Y.
TEST(ExrMeaning, LuminanceAndChromaAreColours) {
    const glm::vec3 color(0.9f, 0.4f, 0.2f);
    const float y = 0.2126f * color.x + 0.7152f * color.y + 0.0722f * color.z;
    const glm::vec3 found =
        read(test::exr(1, 1, {"Y", "RY", "BY"}, {y, (color.x - y) / y, (color.z - y) / y}, false))
            .texels.at(0);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found[i], color[i], 1e-3f) << "channel " << i; // weights of four digits
}

/// Green is there for every other column and row, x + 2 y, and in between by its neighbours; beyond
/// the last one it is the last one's. The other channels are whole.
TEST(ExrMeaning, ChannelsOfFewerPixelsAreInterpolated) {
    constexpr int kSize = 4;
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("stromboli_exr_" + std::to_string(getpid()) + ".exr");
    const std::vector<float> red(kSize * kSize, 7), green{0, 2, 4, 6};
    {
        Imf::Header header(kSize, kSize);
        header.channels().insert("R", Imf::Channel(Imf::FLOAT));
        header.channels().insert("G", Imf::Channel(Imf::FLOAT, 2, 2));
        header.channels().insert("B", Imf::Channel(Imf::FLOAT));
        Imf::FrameBuffer buffer;
        const auto add = [&](const char* name, const std::vector<float>& values, int sampling) {
            buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow(),
                                                 sizeof(float), sizeof(float) * kSize / sampling,
                                                 sampling, sampling));
        };
        add("R", red, 1);
        add("G", green, 2);
        add("B", red, 1);
        Imf::OutputFile out(file.c_str(), header);
        out.setFrameBuffer(buffer);
        out.writePixels(kSize);
    }
    const FloatImage image = readFloatImage(file);
    std::filesystem::remove(file);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            SCOPED_TRACE(std::to_string(x) + ", " + std::to_string(y));
            expectNear(image.texels.at(size_t(y) * kSize + size_t(x)),
                       {7, float(std::min(x, 2) + 2 * std::min(y, 2)), 7});
        }
}

/// Faces of a cube lie below each other: +x, -x, +y, -y, +z, -z. In the environment's picture the
/// top is +y, the middle column -z, and three quarters of the way is +x.
TEST(ExrMeaning, ACubeIsUnfolded) {
    constexpr uint32_t kFace = 16;
    std::vector<float> values;
    for (uint32_t face = 0; face < 6; ++face)
        for (uint32_t i = 0; i < kFace * kFace; ++i)
            values.insert(values.end(), {float(face + 1), 0, float(10 * face)});
    const FloatImage image =
        read(test::exr(kFace, 6 * kFace, {"R", "G", "B"}, values, false,
                       [](Imf::Header& header) { Imf::addEnvmap(header, Imf::ENVMAP_CUBE); }));
    ASSERT_EQ(image.width, 2 * image.height);
    const auto at = [&](double column, double row) {
        return image.texels.at(size_t(row * image.height) * image.width +
                               size_t(column * image.width));
    };
    expectNear(at(0.75, 0.5), {1, 0, 0});
    expectNear(at(0.25, 0.5), {2, 0, 10});
    expectNear(at(0.5, 0.02), {3, 0, 20});
    expectNear(at(0.5, 0.98), {4, 0, 30});
    expectNear(at(0.02, 0.5), {5, 0, 40});
    expectNear(at(0.5, 0.5), {6, 0, 50});
}

/// OpenEXR's maps of latitude and longitude have +z in their middle.
TEST(ExrMeaning, AMapOfDirectionsIsTurned) {
    const FloatImage image =
        read(test::exr(4, 2, {"Y"}, {1, 2, 3, 4, 5, 6, 7, 8}, false,
                       [](Imf::Header& header) { Imf::addEnvmap(header, Imf::ENVMAP_LATLONG); }));
    EXPECT_EQ(image.texels.at(0).x, 3);
    EXPECT_EQ(image.texels.at(3).x, 2);
    EXPECT_EQ(image.texels.at(4).x, 7);
}

} // namespace
} // namespace stromboli::images
