#include "scene/build/ear_clipper.hpp"

#include "scene/build/orientation.hpp"

#include <deque>

namespace stromboli::build {

EarClipper::EarClipper(std::span<const glm::dvec2> polygon)
    : points_(polygon), previous_(polygon.size()), next_(polygon.size()), isReflex_(polygon.size()),
      isGone_(polygon.size()), remaining_(uint32_t(polygon.size())) {
    for (uint32_t i = 0; i < remaining_; ++i) {
        previous_[i] = (i + remaining_ - 1) % remaining_;
        next_[i] = (i + 1) % remaining_;
    }
    std::vector<uint32_t> reflex;
    for (uint32_t i = 0; i < remaining_; ++i) {
        isReflex_[i] = !turnsLeft(i);
        if (isReflex_[i]) reflex.push_back(i);
    }
    reflex_ = CornerTree(polygon, std::move(reflex));
}

bool EarClipper::turnsLeft(uint32_t corner) const {
    return orientation(points_[previous_[corner]], points_[corner], points_[next_[corner]]) > 0;
}

bool EarClipper::blocks(uint32_t corner, uint32_t a, uint32_t b, uint32_t c) const {
    if (!isReflex_[corner] || corner == a || corner == b || corner == c) return false;
    const glm::dvec2 &p = points_[corner], &pa = points_[a], &pb = points_[b], &pc = points_[c];
    // Where a polygon touches itself (a hole joined to the outline), corners share a place.
    if (p == pa || p == pb || p == pc) return false;
    return orientation(pa, pb, p) >= 0 && orientation(pb, pc, p) >= 0 &&
           orientation(pc, pa, p) >= 0;
}

bool EarClipper::isEar(uint32_t corner) const {
    const uint32_t a = previous_[corner], b = corner, c = next_[corner];
    // A corner on a straight edge is no ear: it must end up in a triangle of some area, or the
    // neighbour across the edge that has the same corner would no longer fit.
    if (!turnsLeft(corner)) return false;
    return !reflex_.any(points_[a], points_[b], points_[c],
                        [&](uint32_t other) { return blocks(other, a, b, c); });
}

/// Cutting a corner makes the angles at its neighbours smaller: they can come to turn left.
void EarClipper::update(uint32_t corner) {
    if (!isReflex_[corner] || !turnsLeft(corner)) return;
    isReflex_[corner] = false;
    reflex_.remove(corner);
}

/// Cuts every ear there is, and those that appear next to a cut. Returns true if it cut any.
bool EarClipper::clipAll(std::vector<std::array<uint32_t, 3>>& triangles) {
    std::deque<uint32_t> candidates;
    for (uint32_t i = 0, corner = start_; i < remaining_; ++i, corner = next_[corner])
        candidates.push_back(corner);
    const uint32_t before = remaining_;
    while (!candidates.empty() && remaining_ > 3) {
        const uint32_t corner = candidates.front();
        candidates.pop_front();
        if (isGone_[corner] || !isEar(corner)) continue;
        const uint32_t a = previous_[corner], c = next_[corner];
        triangles.push_back({a, corner, c});
        next_[a] = c, previous_[c] = a;
        isGone_[corner] = true;
        start_ = c;
        --remaining_;
        for (uint32_t neighbour : {a, c}) {
            update(neighbour);
            candidates.push_back(neighbour);
        }
    }
    return remaining_ < before;
}

bool EarClipper::run(std::vector<std::array<uint32_t, 3>>& triangles) {
    while (remaining_ > 3 && clipAll(triangles)) {
    }
    const bool simple = remaining_ == 3;
    for (uint32_t b = next_[start_], c = next_[b]; c != start_; b = c, c = next_[c])
        triangles.push_back({start_, b, c});
    return simple;
}

} // namespace stromboli::build
