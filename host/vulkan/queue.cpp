#include "host/vulkan/queue.hpp"

#include "host/vulkan/instance.hpp"

#include <chrono>

namespace stromboli::vulkan {

namespace {

Handle<VkCommandPool> createPool(const Device& device) {
    const VkCommandPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                          .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                          .queueFamilyIndex =
                                              uint32_t(device.description().queueFamily)};
    VkCommandPool pool = VK_NULL_HANDLE;
    check(device.vk().vkCreateCommandPool(device.handle(), &info, nullptr, &pool),
          "create a command pool");
    return {device.handle(), pool, device.vk().vkDestroyCommandPool};
}

VkCommandBuffer createCommands(const Device& device, VkCommandPool pool) {
    const VkCommandBufferAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                              .commandPool = pool,
                                              .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                              .commandBufferCount = 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(device.vk().vkAllocateCommandBuffers(device.handle(), &info, &commands),
          "create a command buffer");
    return commands;
}

Handle<VkFence> createFence(const Device& device) {
    const VkFenceCreateInfo info = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VkFence fence = VK_NULL_HANDLE;
    check(device.vk().vkCreateFence(device.handle(), &info, nullptr, &fence), "create a fence");
    return {device.handle(), fence, device.vk().vkDestroyFence};
}

Handle<VkQueryPool> createTimestamps(const Device& device) {
    if (device.description().timestampBits == 0) return {};
    const VkQueryPoolCreateInfo info = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = 2};
    VkQueryPool pool = VK_NULL_HANDLE;
    check(device.vk().vkCreateQueryPool(device.handle(), &info, nullptr, &pool),
          "create timestamp queries");
    return {device.handle(), pool, device.vk().vkDestroyQueryPool};
}

} // namespace

Queue::Queue(const Device& device)
    : device_(device), pool_(createPool(device)), commands_(createCommands(device, pool_.get())),
      fence_(createFence(device)), timestamps_(createTimestamps(device)) {}

Queue::~Queue() {
    device_.vk().vkDeviceWaitIdle(device_.handle());
}

double Queue::run(const char* what, const std::function<void(VkCommandBuffer)>& record) {
    const VolkDeviceTable& vk = device_.vk();
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vk.vkBeginCommandBuffer(commands_, &begin), what);
    if (timestamps_) {
        vk.vkCmdResetQueryPool(commands_, timestamps_.get(), 0, 2);
        vk.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_.get(), 0);
    }
    record(commands_);
    if (timestamps_)
        vk.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_.get(),
                               1);
    check(vk.vkEndCommandBuffer(commands_), what);

    const auto start = std::chrono::steady_clock::now();
    const VkFence fence = fence_.get();
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands_};
    check(vk.vkQueueSubmit(device_.queue(), 1, &submit, fence), what);
    check(vk.vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX), what);
    check(vk.vkResetFences(device_.handle(), 1, &fence), what);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    if (!timestamps_) return wall.count();

    uint64_t ticks[2] = {0, 0};
    check(vk.vkGetQueryPoolResults(device_.handle(), timestamps_.get(), 0, 2, sizeof ticks, ticks,
                                   sizeof ticks[0],
                                   VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          what);
    const uint32_t bits = device_.description().timestampBits;
    const uint64_t mask = bits >= 64 ? ~uint64_t(0) : (uint64_t(1) << bits) - 1;
    const double nanoseconds =
        double((ticks[1] - ticks[0]) & mask) * double(device_.limits().timestampPeriod);
    return nanoseconds * 1e-9; // ns to s
}

void fullBarrier(const Device& device, VkCommandBuffer commands) {
    const VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT |
                         VK_ACCESS_UNIFORM_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT |
                         VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT |
                         VK_ACCESS_INDIRECT_COMMAND_READ_BIT};
    const VkPipelineStageFlags device_ =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    device.vk().vkCmdPipelineBarrier(commands, device_,
                                     device_ | VK_PIPELINE_STAGE_HOST_BIT |
                                         VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                                     0, 1, &barrier, 0, nullptr, 0, nullptr);
}

} // namespace stromboli::vulkan
