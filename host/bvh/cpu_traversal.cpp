#include "host/bvh/cpu_traversal.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace stromboli {

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

    /// With a ray in the prototype's space for boxes, as shaders/include/placements.glsl has it.
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
            const auto hit = hitSphere(r.p0, r.radius, prepared_, ray_.tMin, hit_.t);
            if (hit) hit_ = {2 * record, hit->t, 0, 0, gpu::NO_PLACEMENT};
            return;
        }
        const glm::vec3 p0 = inWorld(r.p0), p2 = inWorld(r.p2);
        visitTriangle(p0, inWorld(r.p1), p2, 2 * record);
        visitTriangle(p0, p2, inWorld(r.p3), 2 * record + 1);
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

bool anyHit(const WideLayout& layout, const TraversalRay& ray, TraversalCounts* counts) {
    return bool(trace(layout, ray, true, counts));
}

} // namespace stromboli
