#include "host/bvh/wide_layout.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/analytic/scenes.hpp"
#include "tests/support/device_fixture.hpp"

namespace stromboli::test {

// A sample is a product and sum of some hundred float operations, each good to 2^-24 to 2^-22;
// over a path of 100 bounces the errors add up.
const double kRounding = 0x1p-14;

const bool kCombinesLightSamplesWithBounces = true;

namespace {

/// Any message of the validation layer fails the test that was running.
class ValidationListener : public testing::EmptyTestEventListener {
    void OnTestStart(const testing::TestInfo&) override { before_ = validationMessages(); }
    void OnTestEnd(const testing::TestInfo&) override {
        EXPECT_EQ(validationMessages(), before_) << "the validation layer had something to say";
    }
    uint32_t before_ = 0;
};

const bool kListening = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new ValidationListener);
    return true;
}();

} // namespace

Film renderFilm(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                unsigned) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    VulkanBackend backend(testDevice(), gpu, camera, settings);
    return render(backend, settings);
}

/// From the last to the first: the order is nothing to a sample.
std::vector<SampleValue> samplesAlone(const Scene& scene, const Camera& camera,
                                      const RenderSettings& settings, uint32_t pixel,
                                      uint32_t count) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    VulkanBackend backend(testDevice(), gpu, camera, settings);
    std::vector<SampleValue> samples(count);
    for (uint32_t i = count; i-- > 0;)
        samples[i] = backend.sampleAlone(pixel, i);
    return samples;
}

RecordedPath recordedAlone(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                           uint32_t pixel, uint32_t sample) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    return VulkanBackend(testDevice(), gpu, camera, settings).record(pixel, sample);
}

std::vector<SeenPixel> seenBy(const Scene& scene, const Camera& camera,
                              const RenderSettings& settings, const std::vector<uint32_t>& samples,
                              Seeing what) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    return VulkanBackend(testDevice(), gpu, camera, settings).see(0, samples, what);
}

/// The kernel's two-float sum (shaders/include/numerics.glsl): TwoSum, then FastTwoSum.
glm::dvec3 meanInOrder(std::span<const SampleValue> samples) {
    glm::vec3 high(0.0f), low(0.0f);
    for (const SampleValue& s : samples) {
        const glm::vec3 x(s.radiance), sum = high + x, rounded = sum - high;
        const glm::vec3 error = (high - (sum - rounded)) + (x - rounded), rest = low + error;
        high = sum + rest;
        low = rest - (high - sum);
    }
    return (glm::dvec3(high) + glm::dvec3(low)) / double(samples.size());
}

} // namespace stromboli::test
