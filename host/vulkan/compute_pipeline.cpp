#include "host/vulkan/compute_pipeline.hpp"

#include "host/vulkan/instance.hpp"

#include <functional>
#include <optional>
#include <string_view>

namespace stromboli::vulkan {

// --- Compute pipelines ---------------------------------------------------------------------------

namespace {

VkDescriptorType descriptorType(BufferUse use) {
    switch (use) {
    case BufferUse::Texel:
        return VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER;
    case BufferUse::Uniform:
        return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    default:
        return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
}

Handle<VkDescriptorSetLayout> createSetLayout(const Device& device,
                                              std::span<const Binding> bindings) {
    std::vector<BufferUse> uses;
    for (const Binding& b : bindings)
        uses.push_back(b.use);
    requireBindable(device.description(), uses);
    std::vector<VkDescriptorSetLayoutBinding> entries;
    for (const Binding& b : bindings)
        entries.push_back({.binding = b.number,
                           .descriptorType = descriptorType(b.use),
                           .descriptorCount = 1,
                           .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT});
    const VkDescriptorSetLayoutCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = uint32_t(entries.size()),
        .pBindings = entries.data()};
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check(device.vk().vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout),
          "create a descriptor set layout");
    return {device.handle(), layout, device.vk().vkDestroyDescriptorSetLayout};
}

Handle<VkPipelineLayout> createLayout(const Device& device, VkDescriptorSetLayout set,
                                      uint32_t pushBytes) {
    const VkPushConstantRange range = {.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                                       .size = pushBytes};
    const VkPipelineLayoutCreateInfo info = {.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                             .setLayoutCount = 1,
                                             .pSetLayouts = &set,
                                             .pushConstantRangeCount = pushBytes > 0 ? 1u : 0u,
                                             .pPushConstantRanges = &range};
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check(device.vk().vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout),
          "create a pipeline layout");
    return {device.handle(), layout, device.vk().vkDestroyPipelineLayout};
}

Handle<VkPipeline> createPipeline(const Device& device, std::span<const uint32_t> words,
                                  std::span<const uint32_t> constants, VkPipelineLayout layout,
                                  Specialiser specialiser) {
    std::optional<std::vector<uint32_t>> specialised;
    if (specialiser == Specialiser::Ours)
        specialised = device.specialisedModules().get(words, constants);
    if (specialised) {
        words = *specialised;
        constants = {};
    }
    const std::vector<uint32_t> code = withFloatControls(words, device.description().floatControls);
    const VkShaderModuleCreateInfo moduleInfo = {.sType =
                                                     VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
                                                 .codeSize = code.size() * sizeof(uint32_t),
                                                 .pCode = code.data()};
    VkShaderModule module = VK_NULL_HANDLE;
    check(device.vk().vkCreateShaderModule(device.handle(), &moduleInfo, nullptr, &module),
          "create a shader module");
    std::vector<VkSpecializationMapEntry> entries;
    for (uint32_t i = 0; i < constants.size(); ++i)
        entries.push_back({.constantID = i, .offset = 4 * i, .size = 4});
    const VkSpecializationInfo specialisation = {.mapEntryCount = uint32_t(entries.size()),
                                                 .pMapEntries = entries.data(),
                                                 .dataSize = constants.size_bytes(),
                                                 .pData = constants.data()};
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfoEXT lanes = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO_EXT,
        .requiredSubgroupSize = device.description().askedSubgroupSize};
    const VkComputePipelineCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .flags = device.keepsStatistics()
                     ? VkPipelineCreateFlags(VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR)
                     : 0,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .pNext = lanes.requiredSubgroupSize > 0 ? &lanes : nullptr,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = module,
                  .pName = "main",
                  .pSpecializationInfo = &specialisation},
        .layout = layout};
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult result = device.vk().vkCreateComputePipelines(
        device.handle(), device.pipelineCache(), 1, &info, nullptr, &pipeline);
    device.vk().vkDestroyShaderModule(device.handle(), module, nullptr);
    check(result, "compile the kernel");
    return {device.handle(), pipeline, device.vk().vkDestroyPipeline};
}

KeptPipelines::Key keyOf(std::span<const uint32_t> spirv, std::span<const Binding> bindings,
                         std::span<const uint32_t> constants, uint32_t pushConstantBytes,
                         Specialiser specialiser) {
    const auto code = std::as_bytes(spirv);
    KeptPipelines::Key key = {
        std::hash<std::string_view>()({reinterpret_cast<const char*>(code.data()), code.size()}),
        code.size(), pushConstantBytes, uint64_t(specialiser), bindings.size()};
    for (const Binding& b : bindings)
        key.insert(key.end(), {b.number, uint64_t(b.use)});
    key.insert(key.end(), constants.begin(), constants.end());
    return key;
}

} // namespace

ComputePipeline::ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                                 std::span<const Binding> bindings,
                                 std::span<const uint32_t> constants, uint32_t pushConstantBytes,
                                 Specialiser specialiser)
    : compiled_(device.keptPipelines().get(
          keyOf(spirv, bindings, constants, pushConstantBytes, specialiser), [&] {
              CompiledPipeline made{.bindings = {bindings.begin(), bindings.end()}};
              made.setLayout = createSetLayout(device, bindings);
              made.layout = createLayout(device, made.setLayout.get(), pushConstantBytes);
              made.pipeline =
                  createPipeline(device, spirv, constants, made.layout.get(), specialiser);
              device.countPipeline();
              return std::make_shared<const CompiledPipeline>(std::move(made));
          })) {}

DescriptorSet::DescriptorSet(const Device& device, const ComputePipeline& pipeline,
                             std::span<const Buffer* const> buffers) {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& b : pipeline.bindings())
        sizes.push_back({descriptorType(b.use), 1});
    const VkDescriptorPoolCreateInfo poolInfo = {.sType =
                                                     VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                                 .maxSets = 1,
                                                 .poolSizeCount = uint32_t(sizes.size()),
                                                 .pPoolSizes = sizes.data()};
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(device.vk().vkCreateDescriptorPool(device.handle(), &poolInfo, nullptr, &pool),
          "create a descriptor pool");
    pool_ = {device.handle(), pool, device.vk().vkDestroyDescriptorPool};
    const VkDescriptorSetLayout layout = pipeline.setLayout();
    const VkDescriptorSetAllocateInfo info = {.sType =
                                                  VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                              .descriptorPool = pool,
                                              .descriptorSetCount = 1,
                                              .pSetLayouts = &layout};
    check(device.vk().vkAllocateDescriptorSets(device.handle(), &info, &set_),
          "create a descriptor set");

    std::vector<VkDescriptorBufferInfo> infos(buffers.size());
    std::vector<VkBufferView> views(buffers.size());
    std::vector<VkWriteDescriptorSet> writes;
    for (size_t i = 0; i < buffers.size(); ++i) {
        const Binding& binding = pipeline.bindings()[i];
        infos[i] = {buffers[i]->handle(), 0, VK_WHOLE_SIZE};
        views[i] = buffers[i]->view();
        writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                          .dstSet = set_,
                          .dstBinding = binding.number,
                          .descriptorCount = 1,
                          .descriptorType = descriptorType(binding.use),
                          .pBufferInfo = &infos[i],
                          .pTexelBufferView = &views[i]});
    }
    device.vk().vkUpdateDescriptorSets(device.handle(), uint32_t(writes.size()), writes.data(), 0,
                                       nullptr);
}

namespace {

void bind(const Device& device, VkCommandBuffer commands, const ComputePipeline& pipeline,
          const DescriptorSet& set, std::span<const std::byte> pushConstants) {
    const VolkDeviceTable& vk = device.vk();
    const VkDescriptorSet handle = set.handle();
    vk.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.handle());
    vk.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout(), 0, 1,
                               &handle, 0, nullptr);
    if (!pushConstants.empty())
        vk.vkCmdPushConstants(commands, pipeline.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0,
                              uint32_t(pushConstants.size()), pushConstants.data());
}

} // namespace

void recordDispatch(const Device& device, VkCommandBuffer commands, const ComputePipeline& pipeline,
                    const DescriptorSet& set, std::span<const std::byte> pushConstants,
                    uint32_t groups) {
    bind(device, commands, pipeline, set, pushConstants);
    device.vk().vkCmdDispatch(commands, groups, 1, 1);
    fullBarrier(device, commands);
}

void recordIndirectDispatch(const Device& device, VkCommandBuffer commands,
                            const ComputePipeline& pipeline, const DescriptorSet& set,
                            std::span<const std::byte> pushConstants, const Buffer& counts,
                            uint64_t offset) {
    bind(device, commands, pipeline, set, pushConstants);
    device.vk().vkCmdDispatchIndirect(commands, counts.handle(), offset);
    fullBarrier(device, commands);
}

// --- What the driver made of them ----------------------------------------------------------------

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
    const VkPipelineInfoKHR of = {.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR,
                                  .pipeline = pipeline};
    uint32_t one = 1;
    VkPipelineExecutablePropertiesKHR properties = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR};
    check(device.vk().vkGetPipelineExecutablePropertiesKHR(device.handle(), &of, &one, &properties),
          "ask for a kernel's properties");
    std::vector<PipelineStatistic> statistics = {
        {"Subgroup Size", double(properties.subgroupSize)}};
    for (const VkPipelineExecutableStatisticKHR& s : found)
        statistics.push_back({s.name, valueOf(s)});
    return statistics;
}

} // namespace stromboli::vulkan
