#include "host/vulkan/queue.hpp"

#include "host/vulkan/result.hpp"

#include <chrono>

namespace stromboli::vulkan {

Queue::Queue(const Device& device) : device_(device) {
    const VkCommandPoolCreateInfo poolInfo = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
        .queueFamilyIndex = uint32_t(device.description().queueFamily)};
    check(device.vk().vkCreateCommandPool(device.handle(), &poolInfo, nullptr, &pool_),
          "create a command pool");
    const VkCommandBufferAllocateInfo bufferInfo = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = pool_,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    check(device.vk().vkAllocateCommandBuffers(device.handle(), &bufferInfo, &commands_),
          "create a command buffer");
    const VkFenceCreateInfo fenceInfo = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(device.vk().vkCreateFence(device.handle(), &fenceInfo, nullptr, &fence_),
          "create a fence");
    if (device.description().timestampBits == 0) return;
    const VkQueryPoolCreateInfo queryInfo = {.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                             .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                             .queryCount = 2};
    check(device.vk().vkCreateQueryPool(device.handle(), &queryInfo, nullptr, &timestamps_),
          "create timestamp queries");
}

Queue::~Queue() {
    device_.vk().vkDeviceWaitIdle(device_.handle());
    if (timestamps_) device_.vk().vkDestroyQueryPool(device_.handle(), timestamps_, nullptr);
    if (fence_) device_.vk().vkDestroyFence(device_.handle(), fence_, nullptr);
    if (pool_) device_.vk().vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

double Queue::run(const char* what, const std::function<void(VkCommandBuffer)>& record) {
    const VolkDeviceTable& vk = device_.vk();
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                            .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    check(vk.vkBeginCommandBuffer(commands_, &begin), what);
    if (timestamps_) {
        vk.vkCmdResetQueryPool(commands_, timestamps_, 0, 2);
        vk.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_, 0);
    }
    record(commands_);
    if (timestamps_)
        vk.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_, 1);
    check(vk.vkEndCommandBuffer(commands_), what);

    const auto start = std::chrono::steady_clock::now();
    const VkSubmitInfo submit = {.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                 .commandBufferCount = 1,
                                 .pCommandBuffers = &commands_};
    check(vk.vkQueueSubmit(device_.queue(), 1, &submit, fence_), what);
    check(vk.vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX), what);
    check(vk.vkResetFences(device_.handle(), 1, &fence_), what);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    if (!timestamps_) return wall.count();

    uint64_t ticks[2] = {0, 0};
    check(vk.vkGetQueryPoolResults(device_.handle(), timestamps_, 0, 2, sizeof ticks, ticks,
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
                         VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT};
    const VkPipelineStageFlags device_ =
        VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
    device.vk().vkCmdPipelineBarrier(commands, device_, device_ | VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                                     &barrier, 0, nullptr, 0, nullptr);
}

} // namespace stromboli::vulkan
