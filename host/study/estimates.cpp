#include "host/study/estimates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stromboli::study {

namespace {

struct Moments {
    double mean = 0, variance = 0; ///< of one value; 0 for fewer than two
};

Moments momentsOf(std::span<const double> values) {
    Moments m;
    for (const double v : values)
        m.mean += v / double(values.size());
    if (values.size() < 2) return m;
    for (const double v : values)
        m.variance += (v - m.mean) * (v - m.mean) / double(values.size() - 1);
    return m;
}

/// Half width of the 95 % interval of the mean.
double halfWidth(const Moments& m, size_t n) {
    return tQuantile(double(n - 1)) * std::sqrt(m.variance / double(n));
}

/// P(0 < t < x), by Simpson's rule after t = sqrt(n) tan(a): the density becomes cos(a)^(n - 1).
double tProbability(double x, double n) {
    constexpr int kIntervals = 256;
    const double end = std::atan(x / std::sqrt(n)), h = end / kIntervals;
    const double scale =
        std::exp(std::lgamma((n + 1) / 2) - std::lgamma(n / 2)) / std::sqrt(std::numbers::pi);
    double sum = 0;
    for (int i = 0; i <= kIntervals; ++i) {
        const double weight = i == 0 || i == kIntervals ? 1 : i % 2 ? 4 : 2;
        sum += weight * std::pow(std::cos(i * h), n - 1);
    }
    return scale * sum * h / 3;
}

struct Line {
    double slope = 0, offset = 0;
};

std::optional<Line> logLine(const Curve& curve) {
    if (curve.size() < 2) return std::nullopt;
    double mx = 0, my = 0, sxx = 0, sxy = 0;
    for (const auto& [x, y] : curve) {
        mx += std::log(x) / double(curve.size());
        my += std::log(y) / double(curve.size());
    }
    for (const auto& [x, y] : curve) {
        sxx += (std::log(x) - mx) * (std::log(x) - mx);
        sxy += (std::log(x) - mx) * (std::log(y) - my);
    }
    if (!(sxx > 0)) return std::nullopt;
    return Line{sxy / sxx, my - sxy / sxx * mx};
}

double between(double a, double b, double fraction) {
    return std::exp(std::lerp(std::log(a), std::log(b), fraction));
}

} // namespace

double tQuantile(double n) {
    double low = 0, high = 13; // 12.706 for one degree of freedom
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (tProbability(middle, n) < 0.475 ? low : high) = middle;
    }
    return low;
}

Estimate meanOf(std::span<const double> values) {
    const Moments m = momentsOf(values);
    if (values.size() < 2) return {m.mean, std::nullopt};
    const double h = halfWidth(m, values.size());
    return {m.mean, std::pair(m.mean - h, m.mean + h)};
}

Estimate positiveMeanOf(std::span<const double> values) {
    const Moments m = momentsOf(values);
    if (values.size() < 2 || !(m.mean > 0)) return {m.mean, std::nullopt};
    const double factor = std::exp(halfWidth(m, values.size()) / m.mean);
    return {m.mean, std::pair(m.mean / factor, m.mean * factor)};
}

Estimate ratioOf(std::span<const double> logA, std::span<const double> logB) {
    const Moments a = momentsOf(logA), b = momentsOf(logB);
    const double difference = a.mean - b.mean;
    const double na = double(logA.size()), nb = double(logB.size());
    if (na < 2 || nb < 2) return {std::exp(difference), std::nullopt};
    const double va = a.variance / na, vb = b.variance / nb, v = va + vb;
    if (!(v > 0))
        return {std::exp(difference), std::pair(std::exp(difference), std::exp(difference))};
    const double degrees = v * v / (va * va / (na - 1) + vb * vb / (nb - 1));
    const double h = tQuantile(degrees) * std::sqrt(v);
    return {std::exp(difference), std::pair(std::exp(difference - h), std::exp(difference + h))};
}

double medianOf(std::vector<double> values) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::optional<double> logSlope(const Curve& curve) {
    const std::optional<Line> line = logLine(curve);
    return line ? std::optional(line->slope) : std::nullopt;
}

std::optional<Reading> yAt(const Curve& curve, double x) {
    const std::optional<Line> line = logLine(curve);
    if (!line) return std::nullopt;
    for (size_t i = 0; i + 1 < curve.size(); ++i) {
        const auto [x0, y0] = curve[i];
        const auto [x1, y1] = curve[i + 1];
        if (x >= x0 && x <= x1 && x1 > x0)
            return Reading{between(y0, y1, std::log(x / x0) / std::log(x1 / x0)), false};
    }
    return Reading{std::exp(line->offset + line->slope * std::log(x)), true};
}

std::optional<Reading> xAt(const Curve& curve, double y) {
    const std::optional<Line> line = logLine(curve);
    if (!line || !(line->slope < 0)) return std::nullopt;
    for (size_t i = 0; i + 1 < curve.size(); ++i) {
        const auto [x0, y0] = curve[i];
        const auto [x1, y1] = curve[i + 1];
        if (y <= y0 && y >= y1 && y1 < y0)
            return Reading{between(x0, x1, std::log(y / y0) / std::log(y1 / y0)), false};
    }
    return Reading{std::exp((std::log(y) - line->offset) / line->slope), true};
}

} // namespace stromboli::study
