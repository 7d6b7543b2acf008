#include "host/bvh/primitive_bounds.hpp"

#include <cmath>
#include <limits>

namespace stromboli {

namespace {

/// fl(a + b) - (a + b) has the sign of minus this: the part of the exact sum that rounding lost,
/// exactly (Knuth's TwoSum).
float lostInSum(float a, float b, float sum) {
    const float bRounded = sum - a;
    return (a - (sum - bRounded)) + (b - bRounded);
}

/// centre +- radius is rounded to the nearest float, which may lie inside the sphere by up to half
/// an ulp. A ray tangent to the sphere there would miss the box and hit the sphere, so a bound
/// that was rounded inward goes on to the next float, which lies beyond the exact value.
float sumRoundedDown(float a, float b) {
    const float sum = a + b;
    return lostInSum(a, b, sum) < 0 ? std::nextafter(sum, -std::numeric_limits<float>::infinity())
                                    : sum;
}

float sumRoundedUp(float a, float b) {
    return -sumRoundedDown(-a, -b);
}

Bounds sphereBounds(const Sphere& s) {
    Bounds b;
    for (int axis = 0; axis < 3; ++axis) {
        b.lo[axis] = sumRoundedDown(s.center[axis], -s.radius);
        b.hi[axis] = sumRoundedUp(s.center[axis], s.radius);
    }
    return b;
}

} // namespace

Bounds primitiveBounds(const Scene& scene, uint32_t primitive) {
    if (primitive >= scene.triangles.size())
        return sphereBounds(scene.spheres[primitive - scene.triangles.size()]);
    Bounds b;
    glm::vec3 poison(0.0f); // min and max pass over NaN; 0 times it, or infinity, is NaN
    for (const uint32_t corner : scene.triangles[primitive].corner) {
        b.extend(scene.positions[corner]);
        poison += 0.0f * scene.positions[corner];
    }
    b.lo += poison;
    return b;
}

} // namespace stromboli
