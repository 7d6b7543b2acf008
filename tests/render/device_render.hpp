#pragma once

#include "host/film/film.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/settings.hpp"
#include "scene/build/conventions.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <functional>
#include <vector>

namespace stromboli::test {

/// Renders with the Vulkan kernel.
Film renderOnDevice(const vulkan::Device& device, const Scene& scene, const Camera& camera,
                    const RenderSettings& settings, const KernelTuning& tuning = {});

/// Whether all pixels have the same numbers of samples, means and squared deviations, to the bit.
bool sameStatistics(const Film& a, const Film& b);

/// That `pictureWith`, by a KernelTuning, makes the same bytes by the other scheduler, in short
/// dispatches and from storage buffers.
void expectTheSameBytesHoweverTheWorkIsCut(
    const std::function<Film(const KernelTuning&)>& pictureWith);

/// What renders cost: their error for the rays that were cast.
struct Expense {
    double variance = 0; ///< relMSE (docs/guide/study.md)
    double rays = 0;
};

/// Loads a scene of the repository (scene/library) or of ../shared.
Scene loadScene(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// The conventions of reading and framing that --cs184 has beside those of shading; else the
/// default.
SceneConventions readingOf(const Estimator& estimator);
FramingConventions framingOf(const Estimator& estimator);

/// All scenes of scene/library, and of ../shared/scenes where that exists.
std::vector<std::filesystem::path> allScenes();

std::filesystem::path sharedFolder();

} // namespace stromboli::test
