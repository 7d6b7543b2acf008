#include "host/stress/device_subject.hpp"

#include "host/bench/device_rays.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/vulkan/compute_pipeline.hpp"

#include "embedded/random_words.h"

#include <algorithm>

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

constexpr uint32_t kGroupSize = 64; ///< local_size_x of random_words.comp

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

std::vector<RandomBlock> DeviceSubject::randomBlocks(std::span<const Words> counters) {
    using vulkan::Buffer;
    using vulkan::BufferUse;
    const std::vector<vulkan::Binding> bindings = {
        {0, BufferUse::Storage}, {1, BufferUse::Storage}, {2, BufferUse::Storage}};
    const vulkan::ComputePipeline pipeline(device_, random_words, bindings, {}, sizeof(uint32_t));
    vulkan::Queue queue(device_);
    const auto count = uint32_t(counters.size());
    Buffer in(device_, "counters", counters.size_bytes(), BufferUse::Storage);
    Buffer words(device_, "random words", counters.size_bytes(), BufferUse::Storage);
    Buffer numbers(device_, "random numbers", counters.size_bytes(), BufferUse::Storage);
    in.upload(queue, std::as_bytes(counters));
    const std::vector<const Buffer*> buffers = {&in, &words, &numbers};
    const vulkan::DescriptorSet set(device_, pipeline, buffers);
    queue.run("run the random number kernel", [&](VkCommandBuffer commands) {
        vulkan::recordDispatch(device_, commands, pipeline, set,
                               std::as_bytes(std::span(&count, 1)),
                               (count + kGroupSize - 1) / kGroupSize);
    });
    std::vector<Words> hashed(count);
    std::vector<std::array<float, 4>> uniform(count);
    words.download(queue, std::as_writable_bytes(std::span(hashed)));
    numbers.download(queue, std::as_writable_bytes(std::span(uniform)));
    std::vector<RandomBlock> blocks(count);
    for (size_t i = 0; i < count; ++i)
        blocks[i] = {hashed[i], uniform[i]};
    return blocks;
}

} // namespace stromboli::stress
