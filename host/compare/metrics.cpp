#include "host/compare/metrics.hpp"

#include "host/compare/flip.hpp"
#include "host/core/color.hpp"
#include "host/film/image_file.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace stromboli::compare {
namespace {

void requireSameSize(const Picture& a, const Picture& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("the pictures to compare have different sizes");
}

double relativeError(const glm::dvec3& r, const glm::dvec3& x, double epsilon) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const double d = x[c] - r[c];
        // Equal values have no error, in a reference that is black everywhere too (0 / 0).
        if (d != 0) sum += d * d / (r[c] * r[c] + epsilon);
    }
    return sum / 3;
}

} // namespace

double relativeEpsilon(const Picture& reference) {
    double sum = 0;
    for (const glm::dvec3& r : reference.rgb)
        sum += r.x + r.y + r.z;
    const double mean = reference.rgb.empty() ? 0 : sum / (3 * double(reference.rgb.size()));
    return 0.01 * mean * mean;
}

LinearErrors linearErrors(const Picture& reference, const Picture& picture) {
    requireSameSize(reference, picture);
    LinearErrors errors;
    errors.epsilon = relativeEpsilon(reference);
    glm::dvec3 squares(0), differences(0), means(0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const glm::dvec3& r = reference.rgb[i];
        const glm::dvec3 d = picture.rgb[i] - r;
        squares += d * d;
        differences += d;
        means += r;
        errors.relMse += relativeError(r, picture.rgb[i], errors.epsilon);
    }
    const double n = double(reference.rgb.size());
    errors.mse = (squares.x + squares.y + squares.z) / (3 * n);
    errors.relMse /= n;
    for (int c = 0; c < 3; ++c) {
        errors.bias[size_t(c)] = differences[c] / n;
        errors.relativeBias[size_t(c)] = differences[c] == 0 ? 0 : differences[c] / means[c];
    }
    return errors;
}

std::vector<double> relativeErrorMap(const Picture& reference, const Picture& picture) {
    requireSameSize(reference, picture);
    const double epsilon = relativeEpsilon(reference);
    std::vector<double> map(reference.rgb.size());
    for (size_t i = 0; i < map.size(); ++i)
        map[i] = relativeError(reference.rgb[i], picture.rgb[i], epsilon);
    return map;
}

double psnr(const Picture& reference, const Picture& picture, double stops) {
    requireSameSize(reference, picture);
    const double exposure = std::exp2(stops);
    double sum = 0;
    for (size_t i = 0; i < reference.rgb.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double d = srgbFromLinear(exposure * picture.rgb[i][c]) -
                             srgbFromLinear(exposure * reference.rgb[i][c]);
            sum += d * d;
        }
    const double mse = sum / (3 * double(reference.rgb.size()));
    return mse > 0 ? -10 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

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
