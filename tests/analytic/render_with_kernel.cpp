#include "host/bvh/primitive_bounds.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/render.hpp"
#include "tests/analytic/scenes.hpp"
#include "tests/support/device_fixture.hpp"

namespace stromboli::test {

// A sample is a product and sum of some hundred float operations, each good to 2^-24 to 2^-22;
// over a path of 100 bounces the errors add up.
const double kRounding = 0x1p-14;

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
    const GpuScene gpu = packScene(scene, buildBinaryTree(primitiveBounds(scene)), settings.cs184);
    VulkanBackend backend(testDevice(), gpu, camera, settings);
    return render(backend, settings);
}

} // namespace stromboli::test
