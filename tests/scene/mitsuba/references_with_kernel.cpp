#include "host/bvh/wide_layout.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/scene/mitsuba/references_renderer.hpp"
#include "tests/support/device_fixture.hpp"

namespace stromboli::test {

const bool kCombinesLightSamplesWithBounces = true;

Film filmWith(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator));
    VulkanBackend backend(testDevice(), gpu, camera, settings);
    return render(backend, settings);
}

} // namespace stromboli::test
