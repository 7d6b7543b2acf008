#include "host/kernel/occluded_area.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace stromboli {

// --- Axes ----------------------------------------------------------------------------------------

glm::dvec3 usualEdge(const glm::dvec3& normal,
                     std::span<const std::array<glm::dvec3, 3>> triangles) {
    /// Directions that are told apart, of a quarter of a turn.
    constexpr size_t kDirections = 90;
    const glm::dvec3 axis = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(axis - glm::dot(axis, normal) * normal);
    const glm::dvec3 along = glm::cross(normal, across);
    std::vector<glm::dvec2> sums(kDirections, glm::dvec2(0)); ///< of lengths, with their direction
    std::vector<double> lengths(kDirections, 0);
    for (const auto& t : triangles)
        for (size_t i = 0; i < 3; ++i) {
            const glm::dvec3 edge = t[(i + 1) % 3] - t[i];
            glm::dvec2 e(glm::dot(edge, across), glm::dot(edge, along));
            while (!(e.x > 0 && e.y >= 0) && e != glm::dvec2(0))
                e = {-e.y, e.x}; // a quarter of a turn
            const double turn = std::atan2(e.y, e.x) / (0.5 * std::numbers::pi);
            // Directions about 0 are about those of a whole quarter, too.
            const size_t n = size_t(turn * kDirections + 0.5);
            if (n == kDirections) e = {e.y, -e.x};
            sums[n % kDirections] += e;
            lengths[n % kDirections] += glm::length(e);
        }
    const size_t most = size_t(std::ranges::max_element(lengths) - lengths.begin());
    if (!(lengths[most] > 0)) return across;
    return glm::normalize(sums[most].x * across + sums[most].y * along);
}

// --- What is covered -----------------------------------------------------------------------------

namespace {

using Polygon = std::vector<glm::dvec2>; // convex

double side(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

double areaOf(const Polygon& p) {
    double sum = 0;
    for (size_t i = 2; i < p.size(); ++i)
        sum += 0.5 * side(p[0], p[i - 1], p[i]);
    return std::abs(sum);
}

/// The part of a polygon to the left of the line from a to b, and that to its right.
std::pair<Polygon, Polygon> cut(const Polygon& polygon, const glm::dvec2& a, const glm::dvec2& b) {
    std::pair<Polygon, Polygon> parts;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double sp = side(a, b, p), sq = side(a, b, q);
        if (sp >= 0) parts.first.push_back(p);
        if (sp <= 0) parts.second.push_back(p);
        if ((sp > 0 && sq < 0) || (sp < 0 && sq > 0)) {
            const glm::dvec2 between = p + sp / (sp - sq) * (q - p);
            parts.first.push_back(between);
            parts.second.push_back(between);
        }
    }
    return parts;
}

/// What of a polygon lies outside of a triangle, in convex pieces. least: the area of the smallest
/// that counts.
void subtract(const Polygon& polygon, const FlatTriangle& t, double least,
              std::vector<Polygon>& pieces) {
    std::array<glm::dvec2, 3> c = t.corners;
    if (side(c[0], c[1], c[2]) < 0) std::swap(c[1], c[2]);
    Polygon inside = polygon;
    for (size_t i = 0; i < 3; ++i) {
        auto [left, right] = cut(inside, c[i], c[(i + 1) % 3]);
        if (right.size() > 2 && areaOf(right) > least) pieces.push_back(std::move(right));
        inside = std::move(left);
        if (inside.size() < 3) return;
    }
}

/// Whether all of a rectangle lies within a triangle.
bool holds(const FlatTriangle& t, const glm::dvec2& lo, const glm::dvec2& hi) {
    const std::array<glm::dvec2, 3>& c = t.corners;
    const double turn = side(c[0], c[1], c[2]) < 0 ? -1 : 1;
    for (size_t i = 0; i < 3; ++i)
        for (const glm::dvec2& p : {lo, hi, glm::dvec2(hi.x, lo.y), glm::dvec2(lo.x, hi.y)})
            if (turn * side(c[i], c[(i + 1) % 3], p) < 0) return false;
    return true;
}

struct Box {
    glm::dvec2 lo, hi;
};

Box boxOf(const FlatTriangle& t) {
    return {glm::min(glm::min(t.corners[0], t.corners[1]), t.corners[2]),
            glm::max(glm::max(t.corners[0], t.corners[1]), t.corners[2])};
}

} // namespace

bool isCovered(const glm::dvec2& lo, const glm::dvec2& hi,
               std::span<const FlatTriangle> triangles) {
    if (std::ranges::any_of(triangles, [&](const FlatTriangle& t) { return holds(t, lo, hi); }))
        return true;
    const double least = 0x1p-40 * (hi.x - lo.x) * (hi.y - lo.y);
    std::vector<Polygon> rest = {{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}}};
    std::vector<Polygon> pieces;
    for (const FlatTriangle& t : triangles) {
        pieces.clear();
        for (const Polygon& p : rest)
            subtract(p, t, least, pieces);
        std::swap(rest, pieces);
        if (rest.empty()) return true;
    }
    return false;
}

// --- Cells ---------------------------------------------------------------------------------------

OpaqueCells::OpaqueCells(std::span<const FlatTriangle> triangles,
                         std::span<const glm::dvec2> wanted) {
    /// Left out on each side, as a few far crossings would make all cells large.
    constexpr size_t kLeftOut = 50; // one in so many
    if (triangles.empty() || wanted.empty()) return;
    for (const int axis : {0, 1}) {
        std::vector<double> at;
        for (const glm::dvec2& w : wanted)
            at.push_back(w[axis]);
        std::ranges::sort(at);
        lo_[axis] = at[at.size() / kLeftOut];
        hi_[axis] = at[at.size() - 1 - at.size() / kLeftOut];
    }
    Box all = boxOf(triangles.front());
    std::vector<Box> boxes;
    for (const FlatTriangle& t : triangles) {
        boxes.push_back(boxOf(t));
        all = {glm::min(all.lo, boxes.back().lo), glm::max(all.hi, boxes.back().hi)};
    }
    lo_ = glm::max(lo_, all.lo), hi_ = glm::min(hi_, all.hi);
    if (!(lo_.x < hi_.x && lo_.y < hi_.y)) return;
    isCovered_.assign(kOpaqueSide * kOpaqueSide, false);
    for (size_t row = 0; row < kOpaqueSide; ++row) {
        std::vector<size_t> near;
        const double below = cornerOf(0, row).y, above = cornerOf(0, row + 1).y;
        for (size_t i = 0; i < triangles.size(); ++i)
            if (boxes[i].lo.y < above && boxes[i].hi.y > below) near.push_back(i);
        for (size_t column = 0; column < kOpaqueSide; ++column) {
            const glm::dvec2 lo = cornerOf(column, row), hi = cornerOf(column + 1, row + 1);
            std::vector<FlatTriangle> here;
            for (const size_t i : near)
                if (boxes[i].lo.x < hi.x && boxes[i].hi.x > lo.x) here.push_back(triangles[i]);
            isCovered_[row * kOpaqueSide + column] = isCovered(lo, hi, here);
        }
    }
}

glm::dvec2 OpaqueCells::cornerOf(size_t column, size_t row) const {
    return lo_ + (hi_ - lo_) * glm::dvec2(column, row) / double(kOpaqueSide);
}

std::optional<size_t> OpaqueCells::cellAt(const glm::dvec2& place) const {
    if (isCovered_.empty()) return std::nullopt;
    const glm::dvec2 at = (place - lo_) / (hi_ - lo_) * double(kOpaqueSide);
    const bool isInside = at.x >= 0 && at.y >= 0 && at.x < kOpaqueSide && at.y < kOpaqueSide;
    if (!isInside) return std::nullopt;
    const size_t cell = size_t(at.y) * kOpaqueSide + size_t(at.x);
    if (!isCovered_[cell]) return std::nullopt;
    return cell;
}

CellRectangle OpaqueCells::bestRectangle(std::span<const uint32_t> counts) const {
    CellRectangle best;
    if (isCovered_.empty()) return best;
    for (size_t first = 0; first < kOpaqueSide; ++first) {
        std::vector<uint32_t> sums(kOpaqueSide, 0);
        std::vector<bool> isWhole(kOpaqueSide, true);
        for (size_t row = first; row < kOpaqueSide; ++row) {
            CellRectangle run{0, first, 0, row + 1 - first, 0};
            for (size_t x = 0; x < kOpaqueSide; ++x) {
                sums[x] += counts[row * kOpaqueSide + x];
                isWhole[x] = isWhole[x] && isCovered_[row * kOpaqueSide + x];
                run.count = isWhole[x] ? run.count + sums[x] : 0;
                run.columns = isWhole[x] ? run.columns + 1 : 0;
                run.column = x + 1 - run.columns;
                const bool isLarger = run.columns * run.rows > best.columns * best.rows;
                if (run.count > best.count || (run.count == best.count && isLarger)) best = run;
            }
        }
    }
    return best;
}

} // namespace stromboli
