#include "host/kernel/frame.hpp"

#include <algorithm>
#include <limits>

namespace stromboli {
namespace {

/// How many direct light samples a shading point takes for other than delta lights.
uint32_t areaSamples(const GpuScene& scene, const Estimator& s) {
    if (samplesLights(s.directLight)) return s.lightSamples * scene.areaLights;
    if (s.directLight == DirectLight::Bsdf) return 0;
    // The CS184 renderer multiplies by the number of all its lights.
    return s.lightSamples * (s.cs184 ? scene.areaLights + scene.deltaLights : scene.areaLights);
}

} // namespace

gpu::Frame makeFrame(const GpuScene& scene, const Camera& camera, const PictureArea& area,
                     const Estimator& s) {
    gpu::Frame f{};
    f.cameraPosition = camera.position;
    f.cameraRight = camera.halfWidth * camera.right;
    f.cameraUp = camera.halfHeight * camera.up;
    f.cameraBack = camera.back;
    f.nearDistance = float(camera.nearDistance);
    f.farDistance = float(std::min(camera.farDistance, double(std::numeric_limits<float>::max())));
    f.width = area.width;
    f.height = area.height;
    f.seed = s.seed;
    f.minBounce = s.minBounce;
    f.maxBounces = s.maxBounces;
    f.terminationProbability = float(s.roulette.terminationProbability);
    f.lightSamples = s.lightSamples;
    f.areaLights = scene.areaLights;
    const bool noDelta = s.cs184 && s.directLight == DirectLight::Hemisphere;
    f.deltaLights = noDelta ? 0 : scene.deltaLights;
    f.areaSamples = areaSamples(scene, s);
    f.branches = s.branches;
    f.lampGap = scene.lampGap;
    return f;
}

} // namespace stromboli
