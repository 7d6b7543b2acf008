#include "tests/denoise/pictures.hpp"

#include "host/core/random.hpp"

#include <cmath>
#include <numbers>

namespace stromboli::test {
namespace {

/// Box and Muller 1958.
float normalNumber(Random& random) {
    const double u = 1 - random.uniform(), v = random.uniform();
    return float(std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v));
}

} // namespace

denoise::NoisyPicture noisyPicture(uint32_t width, uint32_t height, const TruthOf& truth,
                                   uint32_t seed) {
    Random random(seed);
    denoise::NoisyPicture picture{width, height};
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const Truth t = truth(x, y);
            glm::vec3 sum, difference;
            for (int c = 0; c < 3; ++c) {
                // Either half has sqrt(2) times the error of both together.
                const float half = std::sqrt(2.0f) * t.sigma * t.radiance[c];
                const float a = half * normalNumber(random), b = half * normalNumber(random);
                sum[c] = 0.5f * (a + b), difference[c] = 0.5f * (a - b);
            }
            picture.mean.push_back(t.radiance + sum);
            picture.deviation.push_back(difference);
            picture.variance.push_back(t.sigma * t.sigma * t.radiance * t.radiance);
            picture.albedo.push_back(t.albedo);
            picture.normal.push_back(t.normal);
            picture.depth.push_back(t.depth);
        }
    return picture;
}

double relMse(const std::vector<glm::vec3>& picture, uint32_t width, const TruthOf& truth) {
    double mean = 0, sum = 0;
    for (uint32_t i = 0; i < picture.size(); ++i) {
        const glm::dvec3 t = truth(i % width, i / width).radiance;
        mean += (t.x + t.y + t.z) / (3.0 * double(picture.size()));
    }
    for (uint32_t i = 0; i < picture.size(); ++i) {
        const glm::dvec3 t = truth(i % width, i / width).radiance;
        const glm::dvec3 error = glm::dvec3(picture[i]) - t;
        const glm::dvec3 relative = error * error / (t * t + 0.01 * mean * mean);
        sum += (relative.x + relative.y + relative.z) / 3;
    }
    return sum / double(picture.size());
}

Truth room(uint32_t x, uint32_t y, float sigma) {
    Truth t;
    t.sigma = sigma;
    const float u = float(x), v = float(y);
    const bool isFloor = v > 40;
    const bool isLeft = u < 36;
    t.normal = isFloor  ? glm::vec3(0, 1, 0)
               : isLeft ? glm::vec3(0.8f, 0, 0.6f)
                        : glm::vec3(-0.6f, 0, 0.8f);
    t.depth = isFloor ? 200 / (v - 20) : 200 / (25 + std::abs(u - 36) * 0.3f);
    const bool isDark = isFloor && (int(u / 6) + int(v / 4)) % 2 == 0;
    t.albedo = isDark ? glm::vec3(0.2f, 0.1f, 0.1f) : glm::vec3(0.7f, 0.7f, 0.6f);
    const float shadow = u + 0.5f * v > 70 ? 0.4f : 1.0f;
    const float light = shadow * (0.3f + 2 * std::exp(-0.001f * ((u - 30) * (u - 30) + v * v)));
    t.radiance = light * t.albedo;
    return t;
}

float mixed(uint32_t x, uint32_t y, uint32_t which) {
    return float((x * 7919 + y * 104729 + which * 1299709) * 2654435761u >> 22) * 0x1p-10f;
}

} // namespace stromboli::test
