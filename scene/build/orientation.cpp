#include "scene/build/orientation.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace stromboli::build {
namespace {

/// A sum of doubles held without rounding error, as components that do not overlap (J. R.
/// Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// 1997, theorem 10). The largest component comes last.
class ExactSum {
  public:
    void addProduct(double a, double b) {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }

    /// Has the sign of the sum and is within rounding of it.
    double value() const {
        double sum = 0;
        for (int i = 0; i < size_; ++i)
            sum += components_[i];
        return sum;
    }

  private:
    void add(double b) {
        int kept = 0;
        for (int i = 0; i < size_; ++i) {
            // Knuth's two-sum: the rounded sum and its error, exactly.
            const double sum = b + components_[i];
            const double other = sum - b;
            const double error = (b - (sum - other)) + (components_[i] - other);
            if (error != 0) components_[kept++] = error;
            b = sum;
        }
        if (b != 0) components_[kept++] = b;
        size_ = kept;
    }

    std::array<double, 12> components_{};
    int size_ = 0;
};

double exactOrientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    ExactSum sum;
    sum.addProduct(a.x, b.y);
    sum.addProduct(-a.y, b.x);
    sum.addProduct(b.x, c.y);
    sum.addProduct(-b.y, c.x);
    sum.addProduct(c.x, a.y);
    sum.addProduct(-c.y, a.x);
    return sum.value();
}

} // namespace

double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const double left = (a.x - c.x) * (b.y - c.y);
    const double right = (a.y - c.y) * (b.x - c.x);
    const double determinant = left - right;
    // Let u = 2^-53 = epsilon / 2: a product of two rounded differences is off by 3 u of itself
    // and terms of u^2; rounding the difference of the products keeps its sign. 4 u covers both
    // and the rounding of the bound.
    const double bound =
        2 * std::numeric_limits<double>::epsilon() * (std::abs(left) + std::abs(right));
    if (std::abs(determinant) > bound) return determinant;
    return exactOrientation(a, b, c);
}

} // namespace stromboli::build
