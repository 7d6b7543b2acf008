#include "host/stress/device_subject.hpp"

#include "host/bench/device_rays.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/vulkan/compute_pipeline.hpp"

#include "embedded/float_facts.h"
#include "embedded/random_words.h"

#include <algorithm>
#include <initializer_list>
#include <list>

namespace stromboli::stress {
namespace {

/// Sets of the hard cases are smaller.
constexpr uint64_t kMostRays = 1 << 20;

/// Hard cases may have rays that visit thousands of records; few rays a lane leave each many passes
/// before the driver's limit.
bench::RayTuning patientTuning(const vulkan::Device& device, const GpuScene& scene) {
    bench::RayTuning tuning = bench::rayTuning(device, bench::rowBytes(scene, kMostRays));
    tuning.raysPerLane = std::min(tuning.raysPerLane, 8u);
    return tuning;
}

class DeviceTracer final : public RayTracer {
  public:
    DeviceTracer(const vulkan::Device& device, const GpuScene& scene)
        : rays_(device, scene, patientTuning(device, scene)) {}

    uint64_t countHits(std::span<const Ray> rays, bool anyHit) override {
        load(rays, anyHit);
        return rays_.trace().hits;
    }
    std::vector<float> distances(std::span<const Ray> rays) override {
        load(rays, false);
        return rays_.distances();
    }

  private:
    void load(std::span<const Ray> rays, bool anyHit) {
        rays_.load({"stress", anyHit, {rays.begin(), rays.end()}});
    }
    bench::DeviceRays rays_;
};

constexpr uint32_t kGroupSize = 64; ///< local_size_x of random_words.comp and float_facts.comp

} // namespace

std::unique_ptr<RayTracer> DeviceSubject::tracer(const Scene& scene) {
    return std::make_unique<DeviceTracer>(device_, packScene(scene, buildWideBvh(scene)));
}

Picture DeviceSubject::render(const Scene& scene, const Camera& camera,
                              const RenderSettings& settings, const KernelTuning& tuning,
                              const ProgressCallback& progress) {
    const GpuScene packed =
        packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    VulkanBackend backend(device_, packed, camera, settings, tuning);
    Picture picture;
    picture.film = stromboli::render(backend, settings, progress);
    picture.rays = backend.counters().rays;
    return picture;
}

namespace {

/// Runs a kernel that reads `in`, of `count` elements, and writes an element of each output for
/// each of them.
void runOn(const vulkan::Device& device, std::span<const uint32_t> code, uint32_t count,
           std::span<const std::byte> in, std::initializer_list<std::span<std::byte>> outs) {
    using vulkan::Buffer;
    using vulkan::BufferUse;
    std::vector<vulkan::Binding> bindings = {{0, BufferUse::Storage}};
    std::list<Buffer> buffers; // which stay where they are
    buffers.emplace_back(device, "input of a small kernel", in.size(), BufferUse::Storage);
    for (const std::span<std::byte> out : outs) {
        bindings.push_back({uint32_t(bindings.size()), BufferUse::Storage});
        buffers.emplace_back(device, "output of a small kernel", out.size(), BufferUse::Storage);
    }
    std::vector<const Buffer*> bound;
    for (const Buffer& buffer : buffers)
        bound.push_back(&buffer);
    const vulkan::ComputePipeline pipeline(device, code, bindings, {}, sizeof count);
    const vulkan::DescriptorSet set(device, pipeline, bound);
    vulkan::Queue queue(device);
    buffers.front().upload(queue, in);
    queue.run("run a small kernel", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device, commands, pipeline, set, std::as_bytes(std::span(&count, 1)),
                               (count + kGroupSize - 1) / kGroupSize);
    });
    auto buffer = std::next(buffers.begin());
    for (const std::span<std::byte> out : outs)
        (buffer++)->download(queue, out);
}

} // namespace

std::vector<RandomBlock> DeviceSubject::randomBlocks(std::span<const Words> counters) {
    const size_t count = counters.size();
    std::vector<Words> hashed(count);
    std::vector<std::array<float, 4>> uniform(count);
    runOn(device_, random_words, uint32_t(count), std::as_bytes(counters),
          {std::as_writable_bytes(std::span(hashed)), std::as_writable_bytes(std::span(uniform))});
    std::vector<RandomBlock> blocks(count);
    for (size_t i = 0; i < count; ++i)
        blocks[i] = {hashed[i], uniform[i]};
    return blocks;
}

std::vector<FloatFacts> DeviceSubject::floatFacts(std::span<const FloatPair> pairs) {
    const size_t count = pairs.size();
    std::vector<std::array<float, 4>> results(count);
    std::vector<uint32_t> comparisons(count);
    runOn(device_, float_facts, uint32_t(count), std::as_bytes(pairs),
          {std::as_writable_bytes(std::span(results)),
           std::as_writable_bytes(std::span(comparisons))});
    std::vector<FloatFacts> facts(count);
    for (size_t i = 0; i < count; ++i)
        facts[i] = {results[i], comparisons[i]};
    return facts;
}

} // namespace stromboli::stress
