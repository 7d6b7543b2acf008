#include "host/bvh/child_slots.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace stromboli::bvh {

namespace {

constexpr uint32_t kSlots = gpu::WIDE_CHILDREN;
constexpr uint32_t kSets = 1u << kSlots;

/// All sets of slots, smaller ones first.
struct SetsBySize {
    std::array<uint8_t, kSets> set{};
    std::array<uint32_t, kSlots + 2> start{}; ///< by size; one more at the end

    constexpr SetsBySize() {
        uint32_t next = 0;
        for (uint32_t size = 0; size <= kSlots; ++size) {
            start[size] = next;
            for (uint32_t s = 0; s < kSets; ++s)
                if (uint32_t(std::popcount(s)) == size) set[next++] = uint8_t(s);
        }
        start[kSlots + 1] = next;
    }
};
constexpr SetsBySize kSetsBySize;

/// How well a child fits into each slot.
std::array<double, kSlots> gains(const Bounds& child, const glm::dvec3& doubledMiddle) {
    const glm::dvec3 offset = glm::dvec3(child.lo) + glm::dvec3(child.hi) - doubledMiddle;
    // Not 0 for boxes without area, so that their order counts where there are only those.
    const double weight = std::max(double(child.halfArea()), std::numeric_limits<double>::min());
    std::array<double, kSlots> gain;
    for (uint32_t slot = 0; slot < kSlots; ++slot)
        gain[slot] =
            weight * ((slot & 1 ? offset.x : -offset.x) + (slot & 2 ? offset.y : -offset.y) +
                      (slot & 4 ? offset.z : -offset.z));
    return gain;
}

} // namespace

std::array<uint8_t, kSlots> assignSlots(std::span<const Bounds> children) {
    Bounds all;
    for (const Bounds& b : children)
        all.extend(b);
    const glm::dvec3 doubledMiddle = glm::dvec3(all.lo) + glm::dvec3(all.hi);
    // By set of slots: the greatest gain of the first children in them, and the last one's slot.
    std::array<double, kSets> best;
    std::array<uint8_t, kSets> lastSlot;
    best[0] = 0;
    for (uint32_t child = 0; child < children.size(); ++child) {
        const auto gain = gains(children[child], doubledMiddle);
        for (uint32_t i = kSetsBySize.start[child + 1]; i < kSetsBySize.start[child + 2]; ++i) {
            const uint32_t set = kSetsBySize.set[i];
            best[set] = -std::numeric_limits<double>::infinity();
            for (uint32_t rest = set; rest != 0; rest &= rest - 1) {
                const uint32_t slot = uint32_t(std::countr_zero(rest));
                const double total = best[set ^ 1u << slot] + gain[slot];
                if (total > best[set]) best[set] = total, lastSlot[set] = uint8_t(slot);
            }
        }
    }
    const auto sets = kSetsBySize.set.begin();
    uint32_t set = *std::max_element(sets + kSetsBySize.start[children.size()],
                                     sets + kSetsBySize.start[children.size() + 1],
                                     [&](uint8_t a, uint8_t b) { return best[a] < best[b]; });
    std::array<uint8_t, kSlots> slots{};
    for (size_t child = children.size(); child-- > 0;) {
        slots[child] = lastSlot[set];
        set ^= 1u << lastSlot[set];
    }
    return slots;
}

} // namespace stromboli::bvh
