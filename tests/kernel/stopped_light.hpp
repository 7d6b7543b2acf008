// Pictures in which some light samples are stopped before their rays are traced, and how many rays
// they take.
#pragma once

#include "host/kernel/light_table.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>

namespace stromboli::test {

class StoppedLight : public DeviceTest {
  protected:
    StoppedLight() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 16;
        settings_.estimator.maxBounces = 3;
    }

    struct Picture {
        Film film;
        uint64_t rays = 0;
    };

    /// stop: what the scene is given beside what is packed; looks: whether its kernel shall have
    /// this feature then.
    Picture pictureOf(const Scene& loaded, const std::function<void(GpuScene&)>& stop,
                      KernelConstant feature, bool looks, const KernelTuning& tuning) {
        GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
        stop(scene);
        VulkanBackend backend(testDevice(), scene, kRoomView, settings_, tuning);
        EXPECT_EQ(backend.features()[feature] != 0, looks);
        Picture picture;
        picture.film = render(backend, settings_);
        picture.rays = backend.counters().rays;
        return picture;
    }

    /// A fiftieth of the rays is spared at least.
    static void expectTheSameWithFewerRays(const Picture& plain, const Picture& with,
                                           const std::string& what) {
        EXPECT_TRUE(sameStatistics(plain.film, with.film)) << what;
        EXPECT_LT(with.rays, plain.rays - plain.rays / 50) << what;
    }

    /// Shines into the room by its window.
    static Light sun() {
        Light light;
        light.kind = LightKind::Directional;
        light.direction = glm::normalize(glm::vec3(1, -0.4f, 0.2f));
        return light;
    }

    RenderSettings settings_;
};

} // namespace stromboli::test
