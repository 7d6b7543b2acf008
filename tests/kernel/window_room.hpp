// Rooms that the sky lights through a window, and whether two pictures of one agree.
#pragma once

#include "host/core/random.hpp"
#include "host/film/film.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/camera/camera.hpp"
#include "scene/generate/scene_maker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace stromboli::test {

/// Texels that differ tenfold, and a bright one.
inline Environment roughSky() {
    Environment e;
    e.width = 40, e.height = 20;
    Random random(11);
    e.radiance.clear();
    for (uint32_t i = 0; i < e.width * e.height; ++i)
        e.radiance.push_back(random.uniform(0.2f, 2) * glm::vec3(1, 0.8f, 0.6f));
    e.radiance[6 * 40 + 13] = glm::vec3(60);
    return e;
}

/// A closed box of side 2 about the origin but for a window of side `window` in the wall x = -1,
/// seen from within.
inline Scene roomWithWindow(float window) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    b.quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white); // floor
    b.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, white);
    b.quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, white);
    b.quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, white);
    b.quad({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, white);
    const float h = window / 2;
    b.quad({-1, -1, -1}, {0, 1 - h, 0}, {0, 0, 2}, white); // below the window, above, and beside
    b.quad({-1, h, -1}, {0, 1 - h, 0}, {0, 0, 2}, white);
    b.quad({-1, -h, -1}, {0, window, 0}, {0, 0, 1 - h}, white);
    b.quad({-1, -h, h}, {0, window, 0}, {0, 0, 1 - h}, white);
    b.scene.environment = roughSky();
    return b.scene;
}

inline GpuScene packed(const Scene& scene) {
    return packScene(scene, buildWideBvh(scene));
}

/// From a corner of that room to its floor, the window on the left.
inline const Camera kRoomView = lookingAt({0.9, 0.1, 0.7}, {-0.6, -0.4, -0.3}, 0.8);

/// The room with a ball of rough glass, which is lit from both sides, and with lamps.
inline Scene roomWithMore(uint32_t lamps) {
    Scene scene = roomWithWindow(1);
    scenes::SceneMaker b;
    b.scene = scene;
    Material glass;
    glass.kind = MaterialKind::Principled;
    glass.principled.metallic = 0;
    glass.principled.transmission = 1;
    glass.principled.roughness = 0.5f;
    b.sphere({-0.2f, -0.5f, 0}, 0.4f, b.add(glass));
    for (uint32_t i = 0; i < lamps; ++i)
        b.sphere({0.5f, 0.6f, -0.6f + 0.3f * float(i)}, 0.1f, b.add(scenes::emissive(3)));
    return b.scene;
}

/// The sum over blocks of pixels of z^2, where z compares the means of both films.
inline double chiSquare(const Film& a, const Film& b, uint32_t side, size_t& blocks) {
    double sum = 0;
    blocks = 0;
    for (uint32_t top = 0; top < a.height; top += side)
        for (uint32_t left = 0; left < a.width; left += side) {
            double difference = 0, variance = 0;
            for (uint32_t y = top; y < std::min(top + side, a.height); ++y)
                for (uint32_t x = left; x < std::min(left + side, a.width); ++x)
                    for (const Film* film : {&a, &b}) {
                        const PixelStatistics& p = film->pixels[y * a.width + x];
                        difference += (film == &a ? 1 : -1) * p.mean.y;
                        variance += p.m2.y / (double(p.count) * (p.count - 1));
                    }
            if (difference == 0 && variance == 0) continue; // all of it shows a constant sky
            sum += difference * difference / variance;
            ++blocks;
        }
    return sum;
}

/// All of the picture, and blocks of it: chi square is beyond these bounds once in 1e5.
inline void expectAgreement(const Film& a, const Film& b, const std::string& what) {
    size_t one = 0;
    EXPECT_LT(chiSquare(a, b, std::max(a.width, a.height), one), 4.5 * 4.5) << what;
    EXPECT_EQ(one, 1u);
    size_t blocks = 0;
    const double sum = chiSquare(a, b, 6, blocks), deviation = std::sqrt(2 * double(blocks));
    EXPECT_LT(sum, double(blocks) + 5 * deviation) << what;
    EXPECT_GT(sum, double(blocks) - 5 * deviation)
        << what << ": the stated variances are too large";
}

} // namespace stromboli::test
