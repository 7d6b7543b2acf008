#include "host/reference/spherical_triangle.hpp"

#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// Angle at unit `corner` between the great circles to p and to q.
double angleAt(const glm::dvec3& corner, const glm::dvec3& p, const glm::dvec3& q) {
    const glm::dvec3 m = glm::cross(corner, p), n = glm::cross(corner, q);
    return std::atan2(glm::length(glm::cross(m, n)), glm::dot(m, n));
}

/// The unit component of x that is orthogonal to unit y: Arvo's [x | y].
glm::dvec3 orthogonal(const glm::dvec3& x, const glm::dvec3& y) {
    const glm::dvec3 v = x - glm::dot(x, y) * y;
    const double length = glm::length(v);
    return length > 0 ? v / length : Frame(y).x;
}

} // namespace

SphericalTriangle::SphericalTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
    : a_(a), b_(b), c_(c), alpha_(angleAt(a, b, c)) {
    area_ = std::max(alpha_ + angleAt(b, c, a) + angleAt(c, a, b) - kPi, 0.0); // Girard
}

glm::dvec3 SphericalTriangle::sample(double u, double v) const {
    const double cosAlpha = std::cos(alpha_), sinAlpha = std::sin(alpha_);
    const double s = std::sin(u * area_ - alpha_), t = std::cos(u * area_ - alpha_);
    const double x = t - cosAlpha, y = s + sinAlpha * glm::dot(a_, b_);
    const double q = ((y * t - x * s) * cosAlpha - y) / ((y * s + x * t) * sinAlpha);
    const double cosine = std::clamp(q, -1.0, 1.0);
    const glm::dvec3 swung = cosine * a_ + std::sqrt(1 - cosine * cosine) * orthogonal(c_, a_);
    const double z = 1 - v * (1 - glm::dot(swung, b_));
    return z * b_ + std::sqrt(std::max(1 - z * z, 0.0)) * orthogonal(swung, b_);
}

} // namespace stromboli::reference
