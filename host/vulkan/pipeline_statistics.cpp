#include "host/vulkan/pipeline_statistics.hpp"

#include "host/vulkan/result.hpp"

namespace stromboli::vulkan {
namespace {

double valueOf(const VkPipelineExecutableStatisticKHR& s) {
    switch (s.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
        return double(s.value.b32);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
        return double(s.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
        return double(s.value.u64);
    default:
        return s.value.f64;
    }
}

} // namespace

std::vector<PipelineStatistic> statisticsOf(const Device& device, VkPipeline pipeline) {
    // A compute pipeline is one executable.
    const VkPipelineExecutableInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, .pipeline = pipeline};
    uint32_t count = 0;
    const auto get = device.vk().vkGetPipelineExecutableStatisticsKHR;
    check(get(device.handle(), &info, &count, nullptr), "ask for a kernel's statistics");
    std::vector<VkPipelineExecutableStatisticKHR> found(
        count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
    check(get(device.handle(), &info, &count, found.data()), "ask for a kernel's statistics");
    std::vector<PipelineStatistic> statistics;
    for (const VkPipelineExecutableStatisticKHR& s : found)
        statistics.push_back({s.name, valueOf(s)});
    return statistics;
}

} // namespace stromboli::vulkan
