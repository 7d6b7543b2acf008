#include "host/bvh/split_items.hpp"

#include "shaders/shared/scene_types.h"

#include <glm/glm.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace stromboli::bvh {

namespace {

// --- Parts of triangles --------------------------------------------------------------------------

/// A convex polygon: a triangle that planes have cut.
struct Polygon {
    /// Each of the six sides of a box adds a corner at most.
    std::array<glm::dvec3, 9> corner;
    uint32_t corners = 0;

    void add(const glm::dvec3& p) { corner[corners++] = p; }
};

/// The part of the polygon with position * side <= plane * side on the axis; side is 1 or -1. Cut
/// corners are right to some 2^-52 of the coordinates.
Polygon cut(const Polygon& polygon, int axis, double plane, double side) {
    Polygon result;
    for (uint32_t i = 0; i < polygon.corners; ++i) {
        const glm::dvec3 &a = polygon.corner[i], &b = polygon.corner[(i + 1) % polygon.corners];
        const double beyondA = (a[axis] - plane) * side, beyondB = (b[axis] - plane) * side;
        if (beyondA <= 0) result.add(a);
        if ((beyondA < 0 && beyondB > 0) || (beyondA > 0 && beyondB < 0)) {
            glm::dvec3 p = a + (b - a) * (beyondA / (beyondA - beyondB));
            p[axis] = plane;
            result.add(p);
        }
    }
    return result;
}

/// A box in double, empty at first.
struct DoubleBox {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()}, hi{-lo};

    bool empty() const { return lo.x > hi.x; }
    void extend(const glm::dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
    double halfArea() const {
        const glm::dvec3 e = hi - lo;
        return empty() ? 0 : e.x * e.y + e.y * e.z + e.z * e.x;
    }
};

/// What of an item lies in a box.
struct Part {
    std::array<Polygon, 2> triangle; ///< without corners: none
    DoubleBox box;                   ///< of the polygons

    void findBox() {
        box = {};
        for (const Polygon& p : triangle)
            for (uint32_t i = 0; i < p.corners; ++i)
                box.extend(p.corner[i]);
    }
};

Part wholeItem(const Scene& scene, const LeafItem& item) {
    Part part;
    for (uint32_t slot = 0; slot < item.count(); ++slot)
        for (const uint32_t corner : scene.triangles[item.primitive[slot]].corner)
            part.triangle[slot].add(scene.positions[corner]);
    part.findBox();
    return part;
}

Part cut(const Part& part, int axis, double plane, double side) {
    Part result;
    for (uint32_t slot = 0; slot < 2; ++slot)
        result.triangle[slot] = cut(part.triangle[slot], axis, plane, side);
    result.findBox();
    return result;
}

// --- Planes --------------------------------------------------------------------------------------

/// The plane of the coarsest binary grid over [origin, origin + size] that is inside the interval,
/// but for its ends; nothing where the interval is a point or the grid would be finer than 2^-24.
std::optional<double> coarsestPlane(double low, double high, double origin, double size) {
    for (double cell = size / 2; cell > size * 0x1p-24; cell /= 2) {
        double number = std::floor((low - origin) / cell) + 1;
        if (origin + number * cell <= low) ++number; // by rounding
        const double plane = origin + number * cell;
        if (plane < high) return plane;
    }
    return {};
}

/// Where a part is split, and what that saves.
struct Split {
    double gain = 0; ///< half area of the part's box without that of the two it becomes
    int axis = 0;
    double plane = 0;
};

Split bestSplit(const Part& part, const glm::dvec3& origin, double size) {
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        const auto plane = coarsestPlane(part.box.lo[axis], part.box.hi[axis], origin[axis], size);
        if (!plane) continue;
        const double gain = part.box.halfArea() - cut(part, axis, *plane, 1).box.halfArea() -
                            cut(part, axis, *plane, -1).box.halfArea();
        if (gain > best.gain) best = {gain, axis, *plane};
    }
    return best;
}

// --- Splitting what gains most first -------------------------------------------------------------

/// A part that may be split.
struct Candidate {
    Split split;
    uint32_t box; ///< its number
    Part part;

    /// The heap's order: the greatest gain first, and of equal ones the lesser box.
    bool operator<(const Candidate& other) const {
        return split.gain != other.split.gain ? split.gain < other.split.gain : box > other.box;
    }
};

float roundedDown(double x) {
    const auto f = float(x);
    return double(f) > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

/// The box of a part of an item whose largest extent is given.
Bounds widened(const DoubleBox& box, double largestExtent) {
    // The triangle test strays by up to 8u of the triangle's extent; 9u have room for the
    // rounding of cut corners.
    const double margin = 9 * 0x1p-24 * largestExtent;
    Bounds result;
    for (int axis = 0; axis < 3; ++axis) {
        result.lo[axis] = roundedDown(box.lo[axis] - margin);
        result.hi[axis] = -roundedDown(-(box.hi[axis] + margin));
    }
    return result;
}

class Splitting {
  public:
    Splitting(const Scene& scene, std::span<const LeafItem> items, std::vector<Bounds> boxes,
              const SplitOptions& options)
        : scene_(scene), items_(items), options_(options), result_{std::move(boxes), {}} {
        for (uint32_t i = 0; i < items.size(); ++i)
            result_.itemOf.push_back(i);
    }

    ItemBoxes run() {
        const auto most = size_t(options_.most * double(items_.size()));
        if (most == 0) return std::move(result_);
        Bounds whole;
        for (const Bounds& box : result_.boxes)
            whole.extend(box);
        origin_ = whole.lo;
        const glm::dvec3 extent = glm::dvec3(whole.hi) - origin_;
        size_ = std::max({extent.x, extent.y, extent.z});
        leastGain_ = options_.leastGain * medianArea();
        findCandidates();
        for (size_t i = 0; i < most && !heap_.empty(); ++i)
            splitFirst();
        return std::move(result_);
    }

  private:
    /// A triangle's box is larger than the sum of its own projections by what splits can gain.
    double mostGain(uint32_t item) const {
        double projections = 0;
        for (uint32_t slot = 0; slot < items_[item].count(); ++slot) {
            const Triangle& t = scene_.triangles[items_[item].primitive[slot]];
            const glm::dvec3 a = scene_.positions[t.corner[0]];
            const glm::dvec3 normal = glm::cross(glm::dvec3(scene_.positions[t.corner[1]]) - a,
                                                 glm::dvec3(scene_.positions[t.corner[2]]) - a);
            projections += 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
        }
        return result_.boxes[item].halfArea() - projections;
    }

    double medianArea() const {
        std::vector<double> areas;
        for (const Bounds& box : result_.boxes)
            areas.push_back(box.halfArea());
        const auto middle = areas.begin() + ptrdiff_t(areas.size() / 2);
        std::ranges::nth_element(areas, middle);
        return *middle;
    }

    bool canBeSplit(uint32_t item) const {
        const LeafItem& it = items_[item];
        return !it.isPlacement() && it.primitive[0] < scene_.triangles.size() &&
               mostGain(item) > leastGain_;
    }

    void findCandidates() {
        std::vector<uint32_t> able;
        for (uint32_t i = 0; i < items_.size(); ++i)
            if (canBeSplit(i)) able.push_back(i);
        std::vector<Candidate> candidates(able.size());
        tbb::parallel_for(tbb::blocked_range<size_t>(0, able.size(), 256), [&](const auto& r) {
            for (size_t i = r.begin(); i != r.end(); ++i)
                candidates[i] = candidate(able[i], wholeItem(scene_, items_[able[i]]));
        });
        for (Candidate& c : candidates)
            if (isWorthIt(c)) heap_.push_back(std::move(c));
        std::make_heap(heap_.begin(), heap_.end());
    }

    Candidate candidate(uint32_t box, Part part) const {
        return {bestSplit(part, origin_, size_), box, std::move(part)};
    }

    bool isWorthIt(const Candidate& c) const {
        return c.split.gain > leastGain_ &&
               c.split.gain >= options_.leastShare * c.part.box.halfArea();
    }

    void splitFirst() {
        std::pop_heap(heap_.begin(), heap_.end());
        const Candidate first = std::move(heap_.back());
        heap_.pop_back();
        const auto added = uint32_t(result_.boxes.size());
        const uint32_t item = result_.itemOf[first.box];
        result_.boxes.emplace_back();
        result_.itemOf.push_back(item);
        const Split& s = first.split;
        take(first.box, item, cut(first.part, s.axis, s.plane, 1));
        take(added, item, cut(first.part, s.axis, s.plane, -1));
    }

    void take(uint32_t box, uint32_t item, Part part) {
        result_.boxes[box] = widened(part.box, largestExtent(item));
        Candidate c = candidate(box, std::move(part));
        if (!isWorthIt(c)) return;
        heap_.push_back(std::move(c));
        std::push_heap(heap_.begin(), heap_.end());
    }

    double largestExtent(uint32_t item) const {
        const DoubleBox box = wholeItem(scene_, items_[item]).box;
        const glm::dvec3 e = box.hi - box.lo;
        return std::max({e.x, e.y, e.z});
    }

    const Scene& scene_;
    std::span<const LeafItem> items_;
    const SplitOptions& options_;
    ItemBoxes result_;
    glm::dvec3 origin_{0.0};
    double size_ = 0, leastGain_ = 0;
    std::vector<Candidate> heap_;
};

} // namespace

// --- Items in several places of the tree ---------------------------------------------------------

ItemBoxes splitItems(const Scene& scene, std::span<const LeafItem> items, std::vector<Bounds> boxes,
                     const SplitOptions& options) {
    return Splitting(scene, items, std::move(boxes), options).run();
}

} // namespace stromboli::bvh
