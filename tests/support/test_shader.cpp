#include "tests/support/test_shader.hpp"

#include "host/kernel/gpu_scene.hpp"
#include "tests/support/device_fixture.hpp"

#include <string>

namespace stromboli::test {
namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

constexpr uint32_t kBindings = BINDING_COUNT + 2;

std::vector<vulkan::Binding> allBindings(bool texelFetch) {
    std::vector<vulkan::Binding> bindings;
    for (uint32_t i = 0; i < kBindings; ++i) {
        const bool rows = i < SCENE_BINDING_COUNT || i == BINDING_WORK_ITEMS ||
                          i == BINDING_PIXELS || i == BINDING_FILTER || i == BINDING_GUIDE;
        bindings.push_back({i, rows && texelFetch   ? BufferUse::Texel
                               : i == BINDING_FRAME ? BufferUse::Uniform
                                                    : BufferUse::Storage});
    }
    return bindings;
}

} // namespace

ShaderOptions::ShaderOptions() {
    set(SPEC_WORKGROUP_SIZE, 64).set(SPEC_TRAVERSAL_STEPS, 8).set(SPEC_STACK_SIZE, 64);
    for (const uint32_t feature : {SPEC_HAS_TRIANGLES, SPEC_HAS_SPHERES, SPEC_HAS_NORMALS,
                                   SPEC_CORNER_NORMALS, SPEC_HAS_EMISSION})
        set(feature, 1);
    set(SPEC_CLOSURES, gpu::CLOSURE_MASK)
        .set(SPEC_CLOSURES_OF_ALL, 0)
        .set(SPEC_HAS_DISPERSION, 1)
        .set(SPEC_HAS_IRIDESCENCE, 1)
        .set(SPEC_LIGHT_KINDS, ~0u)
        .set(SPEC_LIGHT_SAMPLES, 1);
    set(SPEC_LIGHT_CHOICE, gpu::LIGHT_CHOICE_TREE)
        .set(SPEC_LIGHT_GROUPS, 7)
        .set(SPEC_LIGHT_TREES_BRANCH, 1);
}

ShaderOptions ShaderOptions::texel() {
    ShaderOptions options;
    options.texelFetch = true;
    return options;
}

ShaderOptions& ShaderOptions::set(uint32_t constant, uint32_t value) {
    constants.at(constant) = value;
    return *this;
}

TestShader::TestShader(std::span<const uint32_t> spirv, const ShaderOptions& options)
    : pipeline_(testDevice(), spirv, allBindings(options.texelFetch), options.constants,
                sizeof(gpu::Dispatch)),
      groupSize_(options.constants[SPEC_WORKGROUP_SIZE]), buffers_(kBindings) {
    for (uint32_t i = 0; i < kBindings; ++i)
        setBytes(i, {});
    setOne(BINDING_FRAME, gpu::Frame{});
}

void TestShader::setBytes(uint32_t binding, std::span<const std::byte> bytes) {
    std::optional<Buffer>& buffer = buffers_.at(binding);
    const std::vector<std::byte> zeros(16);
    if (bytes.empty()) bytes = zeros;
    if (!buffer || buffer->bytes() != bytes.size())
        buffer.emplace(testDevice(), "test buffer " + std::to_string(binding), bytes.size(),
                       pipeline_.bindings()[binding].use);
    buffer->upload(testQueue(), bytes);
}

void TestShader::getBytes(uint32_t binding, std::span<std::byte> bytes) {
    buffers_.at(binding)->download(testQueue(), bytes);
}

void TestShader::setScene(const GpuScene& scene) {
    set(BINDING_RECORDS, scene.bvh.records);
    set(BINDING_PRIMITIVES, scene.primitives);
    set(BINDING_MATERIALS, scene.materials);
    set(BINDING_LIGHTS, scene.lights.lights);
    set(BINDING_LIGHT_TABLE, scene.lights.table);
    setBytes(BINDING_ENVIRONMENT, std::as_bytes(scene.lights.environmentRows()));
    setBytes(BINDING_DETAIL, std::as_bytes(std::span(scene.details.rows)));
    gpu::Frame frame{};
    frame.lightCount = scene.lights.entries;
    frame.areaLights = scene.lights.areaCount;
    frame.ambientLight = scene.lights.ambientNumber;
    frame.lightsInGroup0 = scene.lights.lightsInGroup[0];
    frame.lightsInGroup1 = scene.lights.lightsInGroup[1];
    frame.lightsInGroup2 = scene.lights.lightsInGroup[2];
    frame.gapWidth = scene.gapWidth;
    setOne(BINDING_FRAME, frame);
}

void TestShader::run(uint32_t invocations, gpu::Dispatch constants) {
    constants.itemCount = invocations;
    std::vector<const Buffer*> bound;
    for (const std::optional<Buffer>& b : buffers_)
        bound.push_back(&*b);
    const vulkan::DescriptorSet set(testDevice(), pipeline_, bound);
    testQueue().run("run a test shader", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(testDevice(), commands, pipeline_, set,
                               std::as_bytes(std::span(&constants, 1)),
                               (invocations + groupSize_ - 1) / groupSize_);
    });
}

} // namespace stromboli::test
