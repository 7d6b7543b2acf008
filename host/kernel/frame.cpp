#include "host/kernel/frame.hpp"

#include "host/kernel/direct_sampling.hpp"

#include <algorithm>
#include <limits>

namespace stromboli {
gpu::Frame makeFrame(const GpuScene& scene, const Camera& camera, const PictureArea& area,
                     const Estimator& s) {
    gpu::Frame f{};
    f.cameraPosition = camera.position;
    f.cameraRight = camera.halfWidth * camera.right;
    f.cameraUp = camera.halfHeight * camera.up;
    f.cameraBack = camera.backOfMiddle();
    f.lensRadius = float(camera.lensRadius);
    f.focusDistance = float(camera.focusDistance);
    f.nearDistance = float(camera.nearDistance);
    f.farDistance = float(std::min(camera.farDistance, double(std::numeric_limits<float>::max())));
    f.width = area.width;
    f.height = area.height;
    f.seed = s.seed;
    f.minBounce = s.minBounce;
    f.maxBounces = s.maxBounces;
    f.terminationProbability = float(s.roulette.terminationProbability);
    f.lightCount = scene.lights.count;
    f.areaLights = scene.lights.areaCount;
    f.ambientLight = scene.lights.ambientNumber;
    f.lightsInGroup0 = scene.lights.lightsInGroup[0];
    f.lightsInGroup1 = scene.lights.lightsInGroup[1];
    f.lightsInGroup2 = scene.lights.lightsInGroup[2];
    const DirectSampling direct = directSampling(scene.lights, s);
    f.hemisphereSamples = direct.hemisphere;
    f.lightSamples = direct.lights;
    f.branches = s.branches;
    f.gapWidth = scene.gapWidth;
    return f;
}

} // namespace stromboli
