#include "host/bvh/cpu_traversal.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace stromboli {

// --- Tests of a ray ------------------------------------------------------------------------------

namespace {

/// Component `axis` becomes z, and z takes its place.
glm::vec3 permute(glm::vec3 v, int axis) {
    std::swap(v[axis], v.z);
    return v;
}

float largestComponent(const glm::vec3& v) {
    return std::max(v.x, std::max(v.y, v.z));
}

/// What rounding relative to the distance can take from the far end of an interval
/// (docs/theory/numerics.md, "Boxes"; after Ize 2013).
constexpr float kBoxSlack = 1.0f + 0x1p-18f;

/// Below this fraction of the largest component a component of the direction is replaced, so that
/// no 0 * infinity arises.
constexpr float kLeastComponent = 0x1p-60f;

} // namespace

PreparedRay::PreparedRay(const glm::vec3& origin_, const glm::vec3& direction_)
    : origin(origin_), direction(direction_) {
    const glm::vec3 size = glm::abs(direction);
    const float largest = largestComponent(size);
    for (int i = 0; i < 3; ++i) {
        const float component = std::max(size[i], largest * kLeastComponent);
        reciprocal[i] = 1.0f / (direction[i] < 0 ? -component : component);
    }
    octant =
        (reciprocal.x < 0 ? 0u : 1u) | (reciprocal.y < 0 ? 0u : 2u) | (reciprocal.z < 0 ? 0u : 4u);
    axis = size.z == largest ? 2 : (size.x == largest ? 0 : 1);
    const glm::vec3 d = permute(direction, axis);
    shear = {d.x / d.z, d.y / d.z, 1.0f / d.z};
}

uint32_t enterChildren(const gpu::NodeRecord& node, const PreparedRay& ray, float tMax) {
    using Bytes = std::array<uint8_t, gpu::WIDE_CHILDREN>;
    struct Axis {
        uint32_t gridWord;
        Bytes low, high;
    };
    const auto bytesOf = [](uint32_t first, uint32_t second) {
        return std::bit_cast<Bytes>(std::array{first, second});
    };
    const Axis axes[3] = {{node.originAndExponentX, bytesOf(node.lowX0, node.lowX1),
                           bytesOf(node.highX0, node.highX1)},
                          {node.originAndExponentY, bytesOf(node.lowY0, node.lowY1),
                           bytesOf(node.highY0, node.highY1)},
                          {node.originAndExponentZ, bytesOf(node.lowZ0, node.lowZ1),
                           bytesOf(node.highZ0, node.highZ1)}};
    // Bit patterns, as the kernel compares them: those of floats that are not negative compare as
    // the floats do, and negative ones are below them all. All children at once, axis by axis, so
    // that compilers make vectors of them.
    std::array<int32_t, gpu::WIDE_CHILDREN> enter{}, last;
    last.fill(std::bit_cast<int32_t>(tMax));
    for (int i = 0; i < 3; ++i) {
        const float origin = std::bit_cast<float>(axes[i].gridWord & 0xFFFFFF00u);
        const float cell = std::bit_cast<float>((axes[i].gridWord & 255u) << 23);
        const float base = (origin - ray.origin[i]) * ray.reciprocal[i];
        const float scale = cell * ray.reciprocal[i];
        const float nearBase = base - ray.slack[i], farBase = base + ray.slack[i];
        // Near and far by the direction's sign, not as the lesser and the greater of both
        // distances: the inverted box of an absent child must stay inverted.
        const bool ascending = (ray.octant >> i & 1u) != 0;
        const Bytes& nearPlanes = ascending ? axes[i].low : axes[i].high;
        const Bytes& farPlanes = ascending ? axes[i].high : axes[i].low;
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
            const float near = float(nearPlanes[slot]) * scale + nearBase;
            const float far = float(farPlanes[slot]) * scale + farBase;
            enter[slot] = std::max(enter[slot], std::bit_cast<int32_t>(near));
            last[slot] = std::min(last[slot], std::bit_cast<int32_t>(far));
        }
    }
    uint32_t entered = 0;
    for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
        if (enter[slot] <= std::bit_cast<int32_t>(std::bit_cast<float>(last[slot]) * kBoxSlack))
            entered |= 1u << (slot ^ ray.octant);
    return entered;
}

/// Why no ray passes between two triangles: a corner is translated, permuted and sheared to the
/// same bits in every triangle that has it, and an edge's function is computed from the same two
/// rounded products in both triangles of the edge, with opposite signs. Rounding is monotonic, so
/// ab < cd gives fl(ab) <= fl(cd): the sign of fl(ab) - fl(cd) is never inverted, at worst zero,
/// and zero counts as inside: of functions of one sign, that of their sum, no weight is negative;
/// where all are zero weights are NaN, which no comparison takes. Fused products would break this
/// (StromboliTargets.cmake forbids them).
std::optional<PrimitiveHit> hitTriangle(const glm::vec3& v0, const glm::vec3& v1,
                                        const glm::vec3& v2, const PreparedRay& ray) {
    const glm::vec3 a = permute(v0 - ray.origin, ray.axis);
    const glm::vec3 b = permute(v1 - ray.origin, ray.axis);
    const glm::vec3 c = permute(v2 - ray.origin, ray.axis);
    const float ax = a.x - ray.shear.x * a.z, ay = a.y - ray.shear.y * a.z;
    const float bx = b.x - ray.shear.x * b.z, by = b.y - ray.shear.y * b.z;
    const float cx = c.x - ray.shear.x * c.z, cy = c.y - ray.shear.y * c.z;
    const float u = cx * by - cy * bx;
    const float v = ax * cy - ay * cx;
    const float w = bx * ay - by * ax;
    // Weights first: the product of an edge function and a distance may overflow.
    const float inverse = 1.0f / (u + v + w);
    const float b0 = u * inverse, b1 = v * inverse, b2 = w * inverse;
    if (!(b0 >= 0 && b1 >= 0 && b2 >= 0)) return std::nullopt;
    const float t = (b0 * a.z + b1 * b.z + b2 * c.z) * ray.shear.z;
    if (!std::isfinite(t)) return std::nullopt;
    return PrimitiveHit{t, b1, b2};
}

/// The discriminant comes from the line's distance to the centre: b^2 - 4ac has no correct digit
/// left once the sphere is 4096 radii away. The perpendicular to the line is found in two steps:
/// after the first, rounding leaves a part along the line of some 2^-22 of the distance. The root
/// that would cancel comes from the product of the roots.
std::optional<PrimitiveHit> hitSphere(const glm::vec3& center, float radius, const PreparedRay& ray,
                                      float tMin, float tMax) {
    const float inverseLength2 = 1.0f / glm::dot(ray.direction, ray.direction);
    const glm::vec3 f = ray.origin - center;
    const float nearlyClosest = -glm::dot(f, ray.direction) * inverseLength2;
    const glm::vec3 nearlyPerpendicular = f + nearlyClosest * ray.direction;
    const float correction = -glm::dot(nearlyPerpendicular, ray.direction) * inverseLength2;
    const float closest = nearlyClosest + correction;
    const float distance = glm::length(nearlyPerpendicular + correction * ray.direction);
    const float discriminant = (radius - distance) * (radius + distance) * inverseLength2;
    if (!(discriminant >= 0)) return std::nullopt;
    const float q = closest + std::copysign(std::sqrt(discriminant), closest);
    const float fromOrigin = glm::length(f);
    const float product = (fromOrigin - radius) * (fromOrigin + radius) * inverseLength2;
    const float other = q != 0 ? product / q : kInfiniteDistance;
    const float t0 = std::min(q, other), t1 = std::max(q, other);
    const float t = t0 > tMin ? t0 : t1;
    if (!(t > tMin && t < tMax)) return std::nullopt;
    return PrimitiveHit{t, 0, 0};
}

// --- Traversal -----------------------------------------------------------------------------------

namespace {

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Comparisons are written so that NaN fails them.
bool canHit(const TraversalRay& ray) {
    return isFinite(ray.origin) && isFinite(ray.direction) && ray.direction != glm::vec3(0.0f) &&
           ray.tMin < ray.tMax;
}

/// One ray on its way through the tree.
class Traversal {
  public:
    Traversal(const WideLayout& layout, const TraversalRay& ray)
        : layout_(layout), ray_(ray), prepared_(ray.origin, ray.direction), boxes_(prepared_),
          stack_(layout.stackSize - 1) {}

    TraversalHit run(bool stopAtFirst) {
        hit_.t = ray_.tMax;
        stopAtFirst_ = stopAtFirst;
        visitTree(0);
        if (!hit_) hit_.t = kInfiniteDistance;
        return hit_;
    }

    const TraversalCounts& counts() const { return counts_; }

  private:
    /// The root is slot 0 of a group that begins at its record.
    void visitTree(uint32_t root) {
        const uint32_t below = std::exchange(bottom_, waiting_);
        for (uint32_t group = root << 8 | 1u << boxes_.octant; group != 0;) {
            group = step(group);
            if (stopAtFirst_ && hit_) break;
        }
        waiting_ = bottom_; // where it has stopped early
        bottom_ = below;
    }

    /// Goes on in the tree of the placement's prototype, with the ray in the prototype's space
    /// where boxes are tested, as shaders/include/placements.glsl has it.
    void visitPlacement(const gpu::PlacementRecord& p, uint32_t record) {
        const auto transform = std::bit_cast<gpu::TransformRecord>(layout_.records.at(p.transform));
        const glm::vec4 rows[3] = {p.toPrototype0, p.toPrototype1, p.toPrototype2};
        const glm::vec3 away = ray_.origin - glm::vec3(transform.toWorld0.w, transform.toWorld1.w,
                                                       transform.toWorld2.w);
        const glm::vec3 size = glm::abs(away);
        const float length = std::max(size.x, std::max(size.y, size.z)) + transform.reach;
        glm::vec3 origin, direction, slack;
        for (int i = 0; i < 3; ++i) {
            origin[i] = glm::dot(glm::vec3(rows[i]), away);
            direction[i] = glm::dot(glm::vec3(rows[i]), ray_.direction);
            slack[i] = rows[i].w * length;
        }
        boxes_ = PreparedRay(origin, direction);
        boxes_.slack = slack * glm::abs(boxes_.reciprocal);
        transform_ = &transform;
        placement_ = record;
        visitTree(p.root);
        boxes_ = prepared_;
        transform_ = nullptr;
        placement_ = gpu::NO_PLACEMENT;
    }

    static float rowTimes(const glm::vec4& row, const glm::vec3& p) {
        return ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w;
    }

    glm::vec3 inWorld(const glm::vec3& p) const {
        if (!transform_) return p;
        return {rowTimes(transform_->toWorld0, p), rowTimes(transform_->toWorld1, p),
                rowTimes(transform_->toWorld2, p)};
    }

    /// Visits the nearest child of the group; returns the group to go on with, 0 if none is left.
    uint32_t step(uint32_t group) {
        const uint32_t next = uint32_t(std::bit_width(group & 255u)) - 1;
        const uint32_t record = (group >> 8) + (next ^ boxes_.octant);
        uint32_t rest = group ^ (1u << next);
        if ((rest & 255u) == 0) rest = 0;

        const Record& r = layout_.records.at(record);
        if (isNode(r)) {
            ++counts_.nodes;
            const gpu::NodeRecord node = asNode(r);
            if (const uint32_t entered = enterChildren(node, boxes_, hit_.t)) {
                if (rest != 0) push(rest);
                return node.firstChild << 8 | entered; // the record's kind is shifted out
            }
        } else if (isPlacement(r)) {
            if (rest != 0) push(rest);
            visitPlacement(asPlacement(r), record);
            return pop();
        } else {
            ++counts_.leaves;
            visitLeaf(asLeaf(r), record);
        }
        return rest != 0 ? rest : pop();
    }

    void visitLeaf(const gpu::LeafRecord& r, uint32_t record) {
        if (r.primitive & gpu::RECORD_IS_SPHERE) {
            ++counts_.spheres;
            const auto hit =
                hitSphere(r.p0, std::bit_cast<float>(r.homeOrRadius), prepared_, ray_.tMin, hit_.t);
            if (hit) hit_ = {2 * record, hit->t, 0, 0, gpu::NO_PLACEMENT};
            return;
        }
        const glm::vec3 p0 = inWorld(r.p0), p2 = inWorld(r.p2);
        const uint32_t home = 2 * r.homeOrRadius;
        visitTriangle(p0, inWorld(r.p1), p2, home);
        visitTriangle(p0, p2, inWorld(r.p3), home + 1);
    }

    void visitTriangle(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2,
                       uint32_t place) {
        if (place == ray_.skipPrimitive) return;
        const auto hit = hitTriangle(v0, v1, v2, prepared_);
        if (hit && hit->t > ray_.tMin && hit->t < hit_.t)
            hit_ = {place, hit->t, hit->b1, hit->b2, placement_};
    }

    void push(uint32_t group) {
        stack_.at(waiting_++) = group;
        counts_.mostWaiting = std::max(counts_.mostWaiting, waiting_);
    }
    uint32_t pop() { return waiting_ == bottom_ ? 0 : stack_[--waiting_]; }

    const WideLayout& layout_;
    const TraversalRay& ray_;
    PreparedRay prepared_;
    PreparedRay boxes_; ///< the same in the space of the tree that is visited
    const gpu::TransformRecord* transform_ = nullptr; ///< from there; null: it is the world
    uint32_t placement_ = gpu::NO_PLACEMENT;
    bool stopAtFirst_ = false;
    TraversalHit hit_;                  ///< t: the end of the interval still of interest
    std::vector<uint32_t> stack_;       ///< as large as the kernel's; exceeding it throws
    uint32_t waiting_ = 0, bottom_ = 0; ///< entries; those below `bottom_` are the world's
    TraversalCounts counts_;
};

TraversalHit trace(const WideLayout& layout, const TraversalRay& ray, bool stopAtFirst,
                   TraversalCounts* counts) {
    if (!canHit(ray)) return {};
    Traversal traversal(layout, ray);
    const TraversalHit hit = traversal.run(stopAtFirst);
    if (counts) *counts = traversal.counts();
    return hit;
}

} // namespace

TraversalHit closestHit(const WideLayout& layout, const TraversalRay& ray,
                        TraversalCounts* counts) {
    return trace(layout, ray, false, counts);
}

std::optional<std::array<glm::vec3, 3>> cornersAt(const WideLayout& layout,
                                                  const TraversalHit& hit) {
    const gpu::LeafRecord leaf = asLeaf(layout.records[hit.primitive / 2]);
    if (leaf.primitive & gpu::RECORD_IS_SPHERE) return std::nullopt;
    const bool isFirst = hit.primitive % 2 == 0;
    std::array<glm::vec3, 3> corners = {leaf.p0, isFirst ? leaf.p1 : leaf.p2,
                                        isFirst ? leaf.p2 : leaf.p3};
    if (hit.placement == gpu::NO_PLACEMENT) return corners;
    const gpu::PlacementRecord placement = asPlacement(layout.records[hit.placement]);
    const auto t = std::bit_cast<gpu::TransformRecord>(layout.records[placement.transform]);
    for (glm::vec3& p : corners)
        p = {glm::dot(t.toWorld0, glm::vec4(p, 1)), glm::dot(t.toWorld1, glm::vec4(p, 1)),
             glm::dot(t.toWorld2, glm::vec4(p, 1))};
    return corners;
}

bool anyHit(const WideLayout& layout, const TraversalRay& ray, TraversalCounts* counts) {
    return bool(trace(layout, ray, true, counts));
}

} // namespace stromboli
