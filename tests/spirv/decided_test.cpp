// The program's specialiser against the driver's: the device computes the same of both modules.
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/queue.hpp"
#include "tests/support/device_fixture.hpp"

#include "embedded/decided_shader.h"
#include "embedded/ways_shader.h"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;
using namespace vulkan;

constexpr uint32_t kInvocations = 16, kAnswers = 4 * kInvocations;

class Specialised : public DeviceTest {
  protected:
    static std::vector<uint32_t> answersOf(std::span<const uint32_t> code,
                                           std::span<const uint32_t> constants,
                                           Specialiser specialiser) {
        const Device& device = testDevice();
        Queue& queue = testQueue();
        const Binding binding = {0, BufferUse::Storage};
        const ComputePipeline pipeline(device, code, {&binding, 1}, constants, 0, specialiser);
        Buffer buffer(device, "answers", kAnswers * sizeof(uint32_t), BufferUse::Storage);
        const Buffer* const buffers[] = {&buffer};
        const DescriptorSet set(device, pipeline, buffers);
        queue.run("decide", [&](VkCommandBuffer commands) {
            recordDispatch(device, commands, pipeline, set, {}, kInvocations / constants[0]);
        });
        std::vector<uint32_t> answers(kAnswers);
        buffer.download(queue, std::as_writable_bytes(std::span(answers)));
        return answers;
    }
};

TEST_F(Specialised, ShaderAnswersAlikeWhoeverPutsTheConstantsIn) {
    for (const uint32_t asked : {0u, 1u})
        for (const uint32_t kind : {0u, 1u, 2u, 3u, 7u})
            for (const uint32_t times : {0u, 1u, 4u, 1000u}) {
                const uint32_t constants[] = {kInvocations, times, uint32_t(-5) - kind,
                                              asked,        kind,  0x40200000u};
                EXPECT_EQ(answersOf(decided_shader, constants, Specialiser::Ours),
                          answersOf(decided_shader, constants, Specialiser::Drivers))
                    << "asked " << asked << ", kind " << kind << ", times " << times;
            }
}

TEST_F(Specialised, ShaderAnswersAlikeByStraighterWays) {
    for (const uint32_t returnsEarly : {0u, 1u})
        for (const uint32_t times : {0u, 1u, 2u, 5u, 1000u}) {
            const uint32_t constants[] = {kInvocations, times, returnsEarly};
            EXPECT_EQ(answersOf(ways_shader, constants, Specialiser::Ours),
                      answersOf(ways_shader, constants, Specialiser::Drivers))
                << "times " << times << ", returns early " << returnsEarly;
        }
}

} // namespace
} // namespace stromboli
