// Scenes that programs make in memory.
#include "host/api/named_materials.hpp"
#include "host/api/picture_session.hpp"
#include "host/api/scene_maker.hpp"
#include "host/core/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace stromboli {
namespace {

using testing::HasSubstr;

const std::vector<double> kCorners = {-1, 0, -1, -1, 0, 1, 1, 0, 1, 1, 0, -1};
const std::vector<uint32_t> kTwoTriangles = {0, 1, 2, 0, 2, 3};
const std::vector<double> kOnePlace(8, 0.0);

/// A square that shines, seen from above; its material's emission is 2.
std::shared_ptr<const Scene> shiningSquare(api::SceneMaker& maker, uint32_t texture) {
    Material material = api::makeMaterial("diffuse", "shines");
    api::setMaterial(material, "albedo", std::vector<double>{0});
    api::setMaterial(material, "emission", std::vector<double>{2});
    const uint32_t number = maker.addMaterial(material);
    maker.useTexture(number, "emission", texture);
    api::MeshArrays mesh;
    mesh.positions = kCorners;
    mesh.triangles = kTwoTriangles;
    mesh.uvs = kOnePlace;
    mesh.material = number;
    maker.addMesh(mesh);
    api::CameraAsked camera;
    camera.from = {0, 3, 0}, camera.at = {0, 0, 0}, camera.up = {0, 0, -1}, camera.fov = 1;
    maker.addCamera(camera);
    return maker.finish();
}

/// What the reference sees of it.
std::vector<float> colorOf(const std::shared_ptr<const Scene>& scene) {
    DeviceRequest device;
    device.backend = BackendChoice::Reference;
    api::PictureSession session(device);
    RenderRequest request;
    request.size = {1, 1};
    request.budget.mostPathsPerPixel = 1;
    session.begin(scene, request);
    while (session.pass([](const RenderProgress&) { return Next::GoOn; })) {
    }
    std::vector<float> color;
    for (const char* channel : {"R", "G", "B"})
        color.push_back(session.image().channels.at(channel).at(0));
    return color;
}

/// They are linear, and may be brighter than 1; these are halves without rounding.
TEST(SceneMaker, TexturesOfFloats) {
    for (const bool hasAlpha : {false, true}) {
        api::SceneMaker maker("floats");
        std::vector<float> texels;
        for (int i = 0; i < 6; ++i) {
            texels.insert(texels.end(), {3.5f, 0.25f, 0.125f});
            if (hasAlpha) texels.push_back(1);
        }
        const std::vector<float> color =
            colorOf(shiningSquare(maker, maker.addTexture(3, 2, std::span<const float>(texels))));
        EXPECT_THAT(color, testing::ElementsAre(7, 0.5f, 0.25f));
    }
}

TEST(SceneMaker, TexturesOfBytes) {
    api::SceneMaker maker("bytes");
    const std::vector<uint8_t> texels = {255, 0, 51};
    const std::vector<float> color =
        colorOf(shiningSquare(maker, maker.addTexture(1, 1, texels, false)));
    EXPECT_FLOAT_EQ(color[0], 2);
    EXPECT_FLOAT_EQ(color[1], 0);
    EXPECT_NEAR(color[2], 0.4, 1e-6);
}

TEST(SceneMaker, RefusesTexturesThatCannotBe) {
    api::SceneMaker maker("wrong");
    const auto problem = [&](uint32_t width, std::vector<float> texels) -> std::string {
        try {
            maker.addTexture(width, 1, std::span<const float>(texels));
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(problem(1, {1, 2}), HasSubstr("has 3 or 4 numbers for each, not 2 numbers"));
    EXPECT_THAT(problem(0, {}), HasSubstr("0 x 1"));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float wrong : {nan, 65505.0f, -1e9f})
        EXPECT_THAT(problem(1, {0, wrong, 0}), HasSubstr("from -65504 to 65504"));
    EXPECT_EQ(problem(1, {65504, -65504, 0}), "");
}

} // namespace
} // namespace stromboli
