#pragma once

#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {

// Pictures of what camera rays see, and nothing of light.

inline constexpr PictureArea kSeenArea{16, 12, {}};
/// Tolerance for positions and normals of some metres: roundings of a few operations, and of
/// octahedral codes.
inline constexpr double kNear = 1e-4;

inline RenderSettings seenPicture(PixelFilter filter = PixelFilter::Box) {
    RenderSettings s = smallPicture(64, 1);
    s.area = kSeenArea;
    s.estimator.filter = filter;
    s.estimator.showsBackdrop = false;
    return s;
}

inline std::vector<SeenPixel> lookAt(const Scene& scene, const Camera& camera, Seeing what,
                                     uint32_t samples = 16,
                                     const RenderSettings& s = seenPicture()) {
    return seenBy(scene, camera, s, std::vector<uint32_t>(s.area.pixelCount(), samples), what);
}

inline double meanCoverage(const std::vector<SeenPixel>& seen) {
    double sum = 0;
    for (const SeenPixel& p : seen)
        sum += p.coverage();
    return sum / double(seen.size());
}

/// Looks along -z from z = 4, with pixels of 1/4 metre at z = 0.
inline Camera straightDown(bool orthographic = true) {
    Camera c;
    c.orthographic = orthographic;
    c.position = {0, 0, 4};
    c.halfWidth = orthographic ? 2 : 0.5;
    c.halfHeight = orthographic ? 1.5 : 0.375;
    return c;
}

inline Environment constantSky(float radiance) {
    Environment e;
    e.width = e.height = 1;
    e.radiance = {glm::vec3(radiance)};
    return e;
}

} // namespace stromboli::test
