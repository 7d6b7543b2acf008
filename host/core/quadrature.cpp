#include "host/core/quadrature.hpp"

#include <cmath>
#include <numbers>

namespace stromboli {

/// By Newton's method on the Legendre polynomial of that degree, whose roots the first places are
/// close to.
Quadrature gaussLegendre(int count) {
    Quadrature q;
    for (int i = 0; i < count; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
        for (int step = 0; step < 10; ++step) {
            double p = 1, before = 0;
            for (int k = 0; k < count; ++k) {
                const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
                before = p, p = next;
            }
            slope = count * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        q.at.push_back((1 + x) / 2);
        q.weight.push_back(1 / ((1 - x * x) * slope * slope));
    }
    return q;
}

Quadrature midpoints(int count) {
    Quadrature q;
    for (int i = 0; i < count; ++i) {
        q.at.push_back(1 - (i + 0.5) / count);
        q.weight.push_back(1.0 / count);
    }
    return q;
}

} // namespace stromboli
