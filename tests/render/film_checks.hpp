#pragma once

#include "host/film/film.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

namespace stromboli::vulkan {
class Device;
}

namespace stromboli::test {

/// Every number of them, to the bit.
bool sameBytes(const PixelStatistics& a, const PixelStatistics& b);

/// How many pixels have other bytes; all of them where sizes differ.
size_t differingPixels(const Film& a, const Film& b);

void expectSameBytes(const Film& a, const Film& b);

/// That kernel and reference have the same mean in every pixel, by z-tests with a family-wise error
/// of 1e-4, and that the kernel rejects no sample.
void expectKernelAndReferenceAgree(const vulkan::Device& device, const Scene& scene,
                                   const Camera& camera, const RenderSettings& settings);

} // namespace stromboli::test
