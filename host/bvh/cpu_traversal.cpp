#include "host/bvh/cpu_traversal.hpp"

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
    Traversal(const BinaryLayout& layout, std::span<const gpu::Primitive> primitives,
              const TraversalRay& ray)
        : layout_(layout), primitives_(primitives), ray_(ray), prepared_(ray.origin, ray.direction),
          stack_(layout.stackSize) {}

    TraversalHit run(bool stopAtFirst) {
        hit_.t = ray_.tMax;
        uint32_t current = 0;
        while (current != gpu::CHILD_NONE) {
            if (current & gpu::CHILD_LEAF_BIT) {
                visitLeaf(current, stopAtFirst);
                if (stopAtFirst && hit_) break;
                current = pop();
            } else {
                current = visitNode(layout_.nodes[current]);
            }
        }
        if (!hit_) hit_.t = kInfiniteDistance;
        return hit_;
    }

  private:
    /// The child to visit next; a farther one that is hit too is pushed.
    uint32_t visitNode(const gpu::Node& node) {
        const auto left = enterBox(node.leftLow, node.leftHigh, prepared_, hit_.t);
        const auto right = enterBox(node.rightLow, node.rightHigh, prepared_, hit_.t);
        if (left && right) {
            const bool leftFirst = *left <= *right;
            stack_.at(stackTop_++) = leftFirst ? node.right : node.left;
            return leftFirst ? node.left : node.right;
        }
        if (left) return node.left;
        return right ? node.right : pop();
    }

    void visitLeaf(uint32_t reference, bool stopAtFirst) {
        const uint32_t first = reference & gpu::CHILD_FIRST_MASK;
        const uint32_t last =
            first + ((reference & ~gpu::CHILD_LEAF_BIT) >> gpu::CHILD_COUNT_SHIFT);
        for (uint32_t i = first; i <= last; ++i) {
            const gpu::Primitive& primitive = primitives_[i];
            if (i == ray_.skipPrimitive && primitive.kind == gpu::PRIMITIVE_TRIANGLE) continue;
            const auto hit = hitPrimitive(primitive, prepared_, ray_.tMin, hit_.t);
            if (!hit) continue;
            hit_ = {i, hit->t, hit->b1, hit->b2};
            if (stopAtFirst) return;
        }
    }

    uint32_t pop() { return stackTop_ == 0 ? gpu::CHILD_NONE : stack_[--stackTop_]; }

    const BinaryLayout& layout_;
    std::span<const gpu::Primitive> primitives_;
    const TraversalRay& ray_;
    PreparedRay prepared_;
    TraversalHit hit_;            ///< t: the end of the interval still of interest
    std::vector<uint32_t> stack_; ///< as large as the kernel's; exceeding it throws
    uint32_t stackTop_ = 0;
};

} // namespace

TraversalHit closestHit(const BinaryLayout& layout, std::span<const gpu::Primitive> primitives,
                        const TraversalRay& ray) {
    return canHit(ray) ? Traversal(layout, primitives, ray).run(false) : TraversalHit{};
}

bool anyHit(const BinaryLayout& layout, std::span<const gpu::Primitive> primitives,
            const TraversalRay& ray) {
    return canHit(ray) && Traversal(layout, primitives, ray).run(true);
}

} // namespace stromboli
