#include "tests/render/film_checks.hpp"

#include "host/check/cross_check.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/render/device_render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace stromboli::test {

bool sameBytes(const PixelStatistics& a, const PixelStatistics& b) {
    return a.count == b.count && a.rejected == b.rejected && a.firstRejected == b.firstRejected &&
           std::memcmp(&a.mean, &b.mean, sizeof a.mean) == 0 &&
           std::memcmp(&a.m2, &b.m2, sizeof a.m2) == 0;
}

size_t differingPixels(const Film& a, const Film& b) {
    if (a.pixels.size() != b.pixels.size()) return std::max(a.pixels.size(), b.pixels.size());
    size_t different = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        different += !sameBytes(a.pixels[i], b.pixels[i]);
    return different;
}

void expectSameBytes(const Film& a, const Film& b) {
    EXPECT_EQ(differingPixels(a, b), 0u) << "of " << a.pixels.size() << " pixels";
}

void expectKernelAndReferenceAgree(const vulkan::Device& device, const Scene& scene,
                                   const Camera& camera, const RenderSettings& settings) {
    const Film onDevice = renderOnDevice(device, scene, camera, settings);
    ReferenceBackend reference(scene, camera, settings);
    const Film onHost = render(reference, settings);
    CheckSettings check;
    check.familyError = 1e-4;
    const CheckResult result = crossCheck(onDevice, onHost, check);
    EXPECT_TRUE(result.agree()) << formatCheck(result);
    EXPECT_EQ(result.rejectedA, 0u);
}

} // namespace stromboli::test
