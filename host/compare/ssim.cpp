#include "host/compare/ssim.hpp"

#include "host/compare/plane.hpp"
#include "host/core/color.hpp"
#include "host/film/tone.hpp"

#include <cmath>

namespace stromboli::compare {
namespace {

Plane greySignal(const Picture& picture, double stops) {
    const double exposure = std::exp2(stops);
    Plane grey(picture.width, picture.height);
    for (size_t i = 0; i < grey.values.size(); ++i) {
        const glm::dvec3 c = exposure * picture.rgb[i];
        grey.values[i] = luminance({srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z)});
    }
    return grey;
}

Plane product(const Plane& a, const Plane& b) {
    Plane p(a.width, a.height);
    for (size_t i = 0; i < p.values.size(); ++i)
        p.values[i] = a.values[i] * b.values[i];
    return p;
}

} // namespace

double ssim(const Picture& reference, const Picture& picture, double stops) {
    constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    const Kernel window = gaussian(1.5, 5);
    const auto smooth = [&](const Plane& p) { return filter(p, window, window); };
    const Plane a = greySignal(reference, stops), b = greySignal(picture, stops);
    const Plane meanA = smooth(a), meanB = smooth(b);
    const Plane squareA = smooth(product(a, a)), squareB = smooth(product(b, b)),
                mixed = smooth(product(a, b));
    double sum = 0;
    for (size_t i = 0; i < a.values.size(); ++i) {
        const double ma = meanA.values[i], mb = meanB.values[i];
        const double varianceA = squareA.values[i] - ma * ma;
        const double varianceB = squareB.values[i] - mb * mb;
        const double covariance = mixed.values[i] - ma * mb;
        sum += (2 * ma * mb + kC1) * (2 * covariance + kC2) /
               ((ma * ma + mb * mb + kC1) * (varianceA + varianceB + kC2));
    }
    return sum / double(a.values.size());
}

} // namespace stromboli::compare
