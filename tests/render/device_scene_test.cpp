// A scene in the device's memory, and what of it the next one needs no upload for.
#include "host/kernel/kernel_buffers.hpp"
#include "scene/generate/scene_maker.hpp"
#include "shaders/shared/interface.h"
#include "tests/support/device_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace stromboli {
namespace {

using namespace scenes;
using namespace test;

/// sky: packed before; null: it is packed here.
GpuScene triangleAt(float x, float albedo, std::shared_ptr<const EnvironmentTable> sky = {}) {
    SceneMaker b;
    b.quad({x, 0, 0}, {1, 0, 0}, {0, 1, 0}, b.add(diffuse(albedo)));
    b.scene.environment = Environment{"sky", 2, 1, {glm::vec3(1), glm::vec3(2)}};
    return packScene(b.scene, buildWideBvh(b.scene), {}, std::move(sky));
}

std::vector<uint32_t> bindingsOf(const SceneBuffers& buffers) {
    std::vector<uint32_t> bindings;
    for (const auto& [binding, buffer] : buffers)
        bindings.push_back(binding);
    return bindings;
}

class DeviceScenes : public DeviceTest {};

TEST_F(DeviceScenes, UploadWhatDiffersAlone) {
    const DeviceTuning tuning;
    const GpuScene first = triangleAt(0, 0.5f);
    const GpuScene moved = triangleAt(3, 0.5f, first.lights.environment);
    DeviceScene before(testDevice(), first, tuning);
    const VkBuffer sky = before.buffers()[BINDING_ENVIRONMENT].handle();
    SceneBuffers filled = before.releaseWhatIsAlsoIn(moved);
    EXPECT_THAT(bindingsOf(filled),
                testing::ElementsAre(BINDING_PRIMITIVES, BINDING_MATERIALS, BINDING_LIGHTS,
                                     BINDING_LIGHT_TABLE, BINDING_ENVIRONMENT, BINDING_DETAIL));
    const DeviceScene after(testDevice(), moved, tuning, std::move(filled));
    ASSERT_EQ(after.buffers().size(), 7u);
    EXPECT_EQ(after.buffers()[BINDING_ENVIRONMENT].handle(), sky);
}

/// A device that reads the first scene's array would read freed memory when that scene is gone.
TEST_F(DeviceScenes, DoNotReadArraysOfTheSceneBefore) {
    if (!testDevice().description().readsHostPages) GTEST_SKIP() << "the device has copies";
    const GpuScene first = triangleAt(0, 0.5f), other = triangleAt(0, 0.5f);
    ASSERT_EQ(*first.lights.environment->texels, *other.lights.environment->texels);
    DeviceScene before(testDevice(), first, {});
    ASSERT_TRUE(before.buffers()[BINDING_ENVIRONMENT].readsHost());
    SceneBuffers filled = before.releaseWhatIsAlsoIn(other);
    EXPECT_THAT(bindingsOf(filled),
                testing::ElementsAre(BINDING_RECORDS, BINDING_PRIMITIVES, BINDING_MATERIALS,
                                     BINDING_LIGHTS, BINDING_LIGHT_TABLE, BINDING_DETAIL));
}

TEST_F(DeviceScenes, WithOtherMaterialsUploadThem) {
    const GpuScene first = triangleAt(0, 0.5f), painted = triangleAt(0, 0.25f);
    DeviceScene before(testDevice(), first, {});
    EXPECT_FALSE(before.releaseWhatIsAlsoIn(painted).contains(BINDING_MATERIALS));
}

/// A buffer that shaders read as texels is of no use where they read storage.
TEST_F(DeviceScenes, ReadInAnotherWayAreUploadedAnew) {
    const GpuScene scene = triangleAt(0, 0.5f);
    DeviceScene before(testDevice(), scene, {.texelFetch = true});
    const DeviceScene after(testDevice(), scene, {.texelFetch = false},
                            before.releaseWhatIsAlsoIn(scene));
    for (const vulkan::Buffer& buffer : after.buffers())
        EXPECT_EQ(buffer.use(), vulkan::BufferUse::Storage);
}

} // namespace
} // namespace stromboli
