#include "host/compare/metrics.hpp"
#include "host/film/image_file.hpp"
#include "tests/compare/pictures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli::compare {
namespace {

Picture fromSignals(const std::vector<double>& signals, uint32_t width) {
    Picture picture(width, uint32_t(signals.size() / width));
    for (size_t i = 0; i < signals.size(); ++i)
        picture.rgb[i] = glm::dvec3(linearFromSrgb(signals[i]));
    return picture;
}

TEST(Ssim, OfConstantPictures) {
    // No variance: (2 ab + C1) / (a^2 + b^2 + C1).
    const Picture a = fromSignals(std::vector<double>(64, 0.25), 8);
    const Picture b = fromSignals(std::vector<double>(64, 0.75), 8);
    EXPECT_NEAR(ssim(a, b), (2 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4), 1e-6);
    EXPECT_NEAR(ssim(a, a), 1, 1e-12);
}

/// The definition, window by window, in two dimensions.
double plainSsim(const std::vector<double>& a, const std::vector<double>& b, int width) {
    const int height = int(a.size()) / width;
    double sum = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            double w = 0, ma = 0, mb = 0, va = 0, vb = 0, cov = 0;
            const auto forWindow = [&](auto use) {
                for (int j = -5; j <= 5; ++j)
                    for (int i = -5; i <= 5; ++i) {
                        const int px = std::clamp(x + i, 0, width - 1);
                        const int py = std::clamp(y + j, 0, height - 1);
                        use(std::exp(-(i * i + j * j) / 4.5), size_t(py * width + px));
                    }
            };
            forWindow([&](double g, size_t p) { w += g, ma += g * a[p], mb += g * b[p]; });
            ma /= w, mb /= w;
            forWindow([&](double g, size_t p) {
                va += g / w * (a[p] - ma) * (a[p] - ma);
                vb += g / w * (b[p] - mb) * (b[p] - mb);
                cov += g / w * (a[p] - ma) * (b[p] - mb);
            });
            sum += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) /
                   ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
        }
    return sum / double(a.size());
}

TEST(Ssim, OfNoiseIsItsDefinition) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> signal(0, 1);
    std::vector<double> a, b;
    for (int i = 0; i < 17 * 12; ++i) {
        a.push_back(signal(random));
        b.push_back(0.7 * a.back() + 0.3 * signal(random));
    }
    // Signals pass the sRGB curve and its inverse, whose constants meet to some 1e-8.
    EXPECT_NEAR(ssim(fromSignals(a, 17), fromSignals(b, 17)), plainSsim(a, b, 17), 1e-5);
}

TEST(Ssim, ContraryStructureIsNegative) {
    std::vector<double> a, b;
    for (int i = 0; i < 256; ++i) {
        a.push_back((i + i / 16) % 2 ? 0.9 : 0.1);
        b.push_back(1 - a.back());
    }
    EXPECT_LT(ssim(fromSignals(a, 16), fromSignals(b, 16)), -0.9);
}

} // namespace
} // namespace stromboli::compare
