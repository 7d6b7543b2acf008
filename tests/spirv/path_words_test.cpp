// Words of a path in memory: the host makes buffers as large as the shaders have them, and a ray is
// all there.
#include "host/kernel/path_kernel.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/queue.hpp"
#include "shaders/shared/texture_types.h"
#include "tests/support/device_fixture.hpp"

#include "embedded/kept_ray.h"
#include "embedded/path_words.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <span>

namespace stromboli {
namespace {

using namespace test;
using namespace vulkan;

/// What the first lane of a shader of PathBuffer writes into its first words.
template <size_t count>
std::array<uint32_t, count> wordsBy(std::span<const uint32_t> shader,
                                    const KernelFeatures& features) {
    const Device& device = testDevice();
    Queue& queue = testQueue();
    const Binding binding = {BINDING_PATHS, BufferUse::Storage};
    const ComputePipeline pipeline(device, shader, {&binding, 1}, features, 0, Specialiser::Ours);
    std::array<uint32_t, 1024> words{}; // more than two paths have
    Buffer buffer(device, "words", sizeof(words), BufferUse::Storage);
    const Buffer* const buffers[] = {&buffer};
    const DescriptorSet set(device, pipeline, buffers);
    queue.run("words of paths", [&](VkCommandBuffer commands) {
        recordDispatch(device, commands, pipeline, set, {}, 1);
    });
    buffer.download(queue, std::as_writable_bytes(std::span(words)));
    std::array<uint32_t, count> first{};
    std::copy_n(words.begin(), count, first.begin());
    return first;
}

KernelFeatures smallestFeatures() {
    KernelFeatures f{};
    f[SPEC_WORKGROUP_SIZE] = 8;
    f[SPEC_STACK_SIZE] = 1;
    return f;
}

class PathWords : public DeviceTest {};

TEST_F(PathWords, AreAsManyInTheShaders) {
    std::mt19937 random(7);
    std::set<std::array<uint32_t, 2>> seen;
    for (int i = 0; i < 24; ++i) {
        KernelFeatures f = smallestFeatures();
        for (const uint32_t flag : {SPEC_SPLITS, SPEC_HAS_NORMALS, SPEC_TANGENT_FRAMES,
                                    SPEC_HAS_PLACEMENTS, SPEC_HAS_ALPHA, SPEC_STOPS_BEFORE_ANY_RAY})
            f[flag] = random() % 2;
        if (random() % 2) f[SPEC_PIXEL_FILTER] = gpu::FILTER_TABLE;
        f[SPEC_TEXTURE_SLOTS] = random() & random() & ((1u << gpu::TEXTURE_SLOT_COUNT) - 1);
        f[SPEC_CLOSURES] = random() & random() & random() & gpu::CLOSURE_MASK;
        const std::array<uint32_t, 2> words = {pathWords(f, PathScheduler::Persistent),
                                               pathWords(f, PathScheduler::Wavefront)};
        EXPECT_EQ(words, wordsBy<2>(path_words, f)) << i;
        seen.insert(words);
    }
    EXPECT_GT(seen.size(), 12u);
}

/// A ray that is put off, or traced by another stage, is the one that the path asked for: also what
/// it must not hit, in which placement, and what it has passed. No picture tells, since rays start
/// off the surfaces that they leave.
TEST_F(PathWords, HoldAllOfARay) {
    constexpr uint32_t kOrigin = 1, kDirection = 2, kSkipPrimitive = 4, kSkipPlacement = 8,
                       kPassed = 16, kPassedPlacement = 32, kEnds = 64 | 128;
    for (const bool placements : {false, true})
        for (const bool alpha : {false, true}) {
            KernelFeatures f = smallestFeatures();
            f[SPEC_HAS_PLACEMENTS] = placements;
            f[SPEC_HAS_ALPHA] = f[SPEC_STOPS_BEFORE_ANY_RAY] = alpha;
            const uint32_t ray =
                kOrigin | kDirection | kSkipPrimitive | (placements ? kSkipPlacement : 0);
            const auto [dispatches, bounces, lightSamples] = wordsBy<3>(kept_ray, f);
            // Without alpha, dispatches stop before rays that begin: resume() knows their ends.
            const uint32_t passed = kEnds | kPassed | (placements ? kPassedPlacement : 0);
            EXPECT_EQ(dispatches, alpha ? ray | passed : ray);
            if (!alpha) continue; // the words are not laid out for the wavefront scheduler
            EXPECT_EQ(bounces, ray | passed);
            // Light samples begin with nothing passed.
            EXPECT_EQ(lightSamples | kPassedPlacement, ray | passed | kPassedPlacement);
        }
}

} // namespace
} // namespace stromboli
