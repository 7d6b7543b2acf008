#include "host/render/branches.hpp"

#include "scene/model/emitters.hpp"

#include <algorithm>

namespace stromboli {
namespace {

/// More gain little, as the camera ray and the light samples of a branch's share are a tenth of its
/// cost then, and leave fewer samples for edges and shadows.
constexpr uint32_t kMostBranches = 4;
/// Fewer camera rays are not enough for edges and soft shadows.
constexpr uint32_t kLeastSamples = 8;

/// Light samples leave little noise beside that of bounces: not where one sample stands for all of
/// the sky or for many lamps.
bool directLightIsSmooth(const Scene& scene, const RenderSettings& settings) {
    const bool sky = std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light& light) {
        return light.kind == LightKind::Ambient;
    });
    return samplesLights(settings.directLight) && !sky &&
           !haveManyTriangles(collectEmitters(scene));
}

} // namespace

uint32_t branchesThatPay(const Scene& scene, const RenderSettings& settings, uint32_t paths) {
    const bool bounces = settings.integrator == Integrator::Path && settings.maxBounces > 1;
    // Both count samples for what they decide, and mean paths.
    const bool countsPaths = settings.cs184 || settings.adaptive.enabled;
    if (!bounces || countsPaths || !directLightIsSmooth(scene, settings)) return 1;
    uint32_t branches = kMostBranches;
    while (branches > 1 && (paths % branches != 0 || paths / branches < kLeastSamples))
        branches /= 2;
    return branches;
}

void splitSamples(RenderSettings& settings, uint32_t branches) {
    settings.branches = branches;
    settings.samplesPerPixel /= branches;
    settings.stop.meanSamples /= branches;
}

} // namespace stromboli
