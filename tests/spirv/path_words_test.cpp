// Words of a path in memory: the host makes buffers as large as the shaders have them.
#include "host/kernel/path_kernel.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/queue.hpp"
#include "shaders/shared/texture_types.h"
#include "tests/support/device_fixture.hpp"

#include "embedded/path_words.h"

#include <gtest/gtest.h>

#include <random>

namespace stromboli {
namespace {

using namespace test;
using namespace vulkan;

class PathWords : public DeviceTest {
  protected:
    static std::array<uint32_t, 2> asShadersCount(const KernelFeatures& features) {
        const Device& device = testDevice();
        Queue& queue = testQueue();
        const Binding binding = {BINDING_PATHS, BufferUse::Storage};
        const ComputePipeline pipeline(device, path_words, {&binding, 1}, features, 0,
                                       Specialiser::Ours);
        std::array<uint32_t, 2> words{};
        Buffer buffer(device, "words", sizeof(words), BufferUse::Storage);
        const Buffer* const buffers[] = {&buffer};
        const DescriptorSet set(device, pipeline, buffers);
        queue.run("count words", [&](VkCommandBuffer commands) {
            recordDispatch(device, commands, pipeline, set, {}, 1);
        });
        buffer.download(queue, std::as_writable_bytes(std::span(words)));
        return words;
    }
};

TEST_F(PathWords, AreAsManyInTheShaders) {
    std::mt19937 random(7);
    std::set<std::array<uint32_t, 2>> seen;
    for (int i = 0; i < 24; ++i) {
        KernelFeatures f{};
        f[SPEC_WORKGROUP_SIZE] = 8;
        f[SPEC_STACK_SIZE] = 1;
        for (const uint32_t flag : {SPEC_SPLITS, SPEC_HAS_NORMALS, SPEC_TANGENT_FRAMES,
                                    SPEC_HAS_PLACEMENTS, SPEC_HAS_ALPHA, SPEC_STOPS_BEFORE_ANY_RAY})
            f[flag] = random() % 2;
        if (random() % 2) f[SPEC_PIXEL_FILTER] = gpu::FILTER_TABLE;
        f[SPEC_TEXTURE_SLOTS] = random() & random() & ((1u << gpu::TEXTURE_SLOT_COUNT) - 1);
        f[SPEC_CLOSURES] = random() & random() & random() & gpu::CLOSURE_MASK;
        const std::array<uint32_t, 2> words = {pathWords(f, PathScheduler::Persistent),
                                               pathWords(f, PathScheduler::Wavefront)};
        EXPECT_EQ(words, asShadersCount(f)) << i;
        seen.insert(words);
    }
    EXPECT_GT(seen.size(), 12u);
}

} // namespace
} // namespace stromboli
