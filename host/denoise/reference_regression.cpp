#include "host/denoise/reference_regression.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::denoise {
namespace {

/// Albedo, three of the normal, two of the place, and the constant.
constexpr int kFeatures = 7, kConstant = 6;
using Features = std::array<double, kFeatures>;

double squareOf(const glm::dvec3& v) {
    return glm::dot(v, v);
}

/// The normal equations; of the matrix, which is symmetric, what is on and below the diagonal.
class Equations {
  public:
    void add(double weight, const Features& features, const glm::dvec3& radiance) {
        for (size_t i = 0; i < kFeatures; ++i) {
            for (size_t j = 0; j <= i; ++j)
                matrix_[i][j] += weight * features[i] * features[j];
            radiance_[i] += weight * features[i] * radiance;
        }
    }

    /// The solution's part, by elimination of the features one after the other.
    glm::dvec3 constant() const {
        const double sum = matrix_[kConstant][kConstant];
        if (!(sum > 0)) return glm::dvec3(0.0);
        std::array<Features, kFeatures> m = matrix_;
        std::array<glm::dvec3, kFeatures> r = radiance_;
        for (size_t k = 0; k < kConstant; ++k) {
            m[k][k] += double(gpu::DENOISE_REGRESSION_RIDGE) * sum;
            for (size_t i = k + 1; i < kFeatures; ++i) {
                const double factor = m[i][k] / m[k][k];
                for (size_t j = k + 1; j <= i; ++j)
                    m[i][j] -= factor * m[j][k];
                r[i] -= factor * r[k];
            }
        }
        return r[kConstant] / std::max(m[kConstant][kConstant], 1e-3 * sum);
    }

  private:
    std::array<Features, kFeatures> matrix_{};
    std::array<glm::dvec3, kFeatures> radiance_{};
};

} // namespace

glm::dvec2 excess(const Pilot& own, const Pilot& other) {
    const double variance = own.variance + other.variance + 1e-30; // no 0 / 0
    return {std::max(squareOf(other.first - own.first) / variance - 1, 0.0),
            std::max(squareOf(other.second - own.second) / variance - 1, 0.0)};
}

Candidate regressionAt(const Prepared& picture, std::span<const Pilot> pilots, int x, int y) {
    constexpr int kAround = gpu::DENOISE_REGRESSION_REACH;
    const int width = int(picture.width), height = int(picture.height);
    const auto at = [&](int u, int v) { return size_t(v) * size_t(width) + size_t(u); };
    const gpu::DenoisePixel& own = picture.pixels[at(x, y)];
    Equations first, second;
    for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, height - 1); ++v)
        for (int u = std::max(x - kAround, 0); u <= std::min(x + kAround, width - 1); ++u) {
            const gpu::DenoisePixel& q = picture.pixels[at(u, v)];
            const int dx = u - x, dy = v - y;
            const glm::dvec2 unlikely = excess(pilots[at(x, y)], pilots[at(u, v)]);
            const double distance = double(gpu::DENOISE_REGRESSION_DISTANCE) * (dx * dx + dy * dy);
            const glm::dvec3 albedo = glm::dvec3(q.albedo) - glm::dvec3(own.albedo);
            const glm::dvec3 normal = glm::dvec3(q.normal) - glm::dvec3(own.normal);
            const double step = gpu::DENOISE_REGRESSION_STEP;
            const Features features = {sumOf(albedo) / 3, normal.x,  normal.y, normal.z,
                                       step * dx,         step * dy, 1};
            const double color = gpu::DENOISE_LOOSE_COLOR;
            const glm::dvec3 mean(q.mean), deviation(q.deviation), seen(picture.albedo[at(u, v)]);
            first.add(q.weight * std::exp(-distance - color * unlikely.x), features,
                      (mean + deviation) * seen);
            second.add(q.weight * std::exp(-distance - color * unlikely.y), features,
                       (mean - deviation) * seen);
        }
    const glm::dvec3 seen(picture.albedo[at(x, y)]);
    const glm::dvec3 a = first.constant() / seen, b = second.constant() / seen;
    return {0.5 * (a + b) - glm::dvec3(own.mean), 0.5 * (a - b)};
}

} // namespace stromboli::denoise
