#include "scene/build/fresnel.hpp"

#include <cmath>

namespace stromboli::build {

double internalReflection(double ior) {
    constexpr int kSteps = 2000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double squared = (i + 0.5) / kSteps; // the sine's, so that all parts weigh alike
        const double in = std::sqrt(1 - squared), outside = 1 - ior * ior * squared;
        double reflected = 1;
        if (outside > 0) {
            const double out = std::sqrt(outside);
            const double s = (ior * in - out) / (ior * in + out);
            const double p = (in - ior * out) / (in + ior * out);
            reflected = (s * s + p * p) / 2;
        }
        sum += reflected;
    }
    return sum / kSteps;
}

} // namespace stromboli::build
