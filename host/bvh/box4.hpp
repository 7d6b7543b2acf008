#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <cstring>

namespace stromboli::bvh {

/// Four floats in one register (GCC and Clang vector extension): a corner of a box, whose fourth
/// lane is 0. One instruction then does what glm::vec3 needs three for, and the builder does
/// little else than take minima and maxima.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int32_t __attribute__((vector_size(16)));

/// Of equal values (zeros of either sign) the second one. This is associative, so that reductions
/// that keep the order, as TBB's do, are the same to the bit however they are divided.
inline Float4 minimum(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 maximum(Float4 a, Float4 b) {
    return a > b ? a : b;
}
inline Float4 splat(float x) {
    return Float4{x, x, x, x};
}

/// Axis-aligned box; the default one is empty.
struct Box4 {
    Float4 lo = splat(3.402823466e38f);
    Float4 hi = splat(-3.402823466e38f);

    void extend(Float4 p) { lo = minimum(lo, p), hi = maximum(hi, p); }
    void extend(const Box4& b) { lo = minimum(lo, b.lo), hi = maximum(hi, b.hi); }
    /// Half the surface area. The box must not be empty. Coordinates within 2^60 cannot
    /// overflow.
    float halfArea() const {
        const Float4 e = hi - lo;
        return e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
    }
    Bounds bounds() const { return Bounds{{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

/// What the builder moves around: an item's box and its number, 32 bytes, so that a node's
/// items are always one contiguous run of memory.
struct alignas(16) BuildReference {
    float lo[3];
    uint32_t item;
    float hi[3];
    uint32_t unused;

    Box4 box() const {
        // The lane of the item's number is cleared: read as a float it is denormal, and
        // adding denormals is slow.
        constexpr Int4 kXyz{-1, -1, -1, 0};
        Int4 l, h;
        std::memcpy(&l, lo, sizeof l);
        std::memcpy(&h, hi, sizeof h);
        return {reinterpret_cast<Float4>(l & kXyz), reinterpret_cast<Float4>(h & kXyz)};
    }
};

/// Twice the centre of a box: what is compared and binned; the factor does not matter.
inline Float4 doubledCentroid(const Box4& b) {
    return b.lo + b.hi;
}

/// What a node knows of its run of items.
struct RunBounds {
    Box4 box;
    Box4 centroids; ///< of the doubled centroids

    void extend(const Box4& b) {
        box.extend(b);
        centroids.extend(doubledCentroid(b));
    }
    void extend(const RunBounds& r) {
        box.extend(r.box);
        centroids.extend(r.centroids);
    }
};

} // namespace stromboli::bvh
