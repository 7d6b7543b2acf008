// What multiple importance sampling is for: less noise on rough metals than either way to find
// lights alone.
#include "host/render/sampling_session.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

class MisGain : public DeviceTest {
  protected:
    /// Mean over the pixels of the squared difference of two pictures of independent noise, over
    /// the squared mean radiance.
    double noise(DirectLight mode) {
        RenderSettings s;
        s.area.width = 64, s.area.height = 48;
        s.budget.mostSamplesPerPixel = 64;
        s.estimator.maxBounces = 3;
        s.estimator.directLight = mode;
        const Camera camera =
            makeCamera(scene_, CameraChoice::Automatic, s.area.width, s.area.height);
        const Film a = renderOnDevice(testDevice(), scene_, camera, s);
        s.estimator.seed = 1;
        const Film b = renderOnDevice(testDevice(), scene_, camera, s);
        double squares = 0, mean = 0;
        for (size_t i = 0; i < a.pixels.size(); ++i) {
            const glm::dvec3 d = a.pixels[i].mean - b.pixels[i].mean;
            squares += glm::dot(d, d);
            mean += a.pixels[i].mean.x + a.pixels[i].mean.y + a.pixels[i].mean.z;
        }
        return squares * double(a.pixels.size()) / (mean * mean);
    }

    Scene scene_ =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/cornell_metal.dae");
};

TEST_F(MisGain, LessNoiseThanEitherTechnique) {
    const double both = noise(DirectLight::Mis);
    // By hand at 240 x 180, relMSE: 2.3 times and 14 times less.
    EXPECT_LT(both, noise(DirectLight::Lights) / 1.3);
    EXPECT_LT(both, noise(DirectLight::Bsdf) / 3);
}

} // namespace
} // namespace stromboli
