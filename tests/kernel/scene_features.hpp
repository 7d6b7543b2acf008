#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/kernel/light_table.hpp"

namespace stromboli::test {

inline Scene oneTriangle(const Material& material) {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    scene.triangles.push_back({{0, 1, 2}});
    scene.materials = {material};
    scene.instances = {"triangle"};
    return scene;
}

inline KernelFeatures featuresOf(const Scene& scene, const RenderSettings& settings = {},
                                 const DeviceTuning& tuning = {}) {
    return kernelFeatures(packScene(scene, buildWideBvh(scene), lightSelection(settings.estimator)),
                          Camera{}, settings.estimator, tuning);
}

} // namespace stromboli::test
