#include "host/kernel/find_portals.hpp"

#include "host/kernel/feelers.hpp"
#include "shaders/shared/light_types.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

namespace stromboli {

namespace {

/// More of the samples do not aim at portals: the light of a sun, or of what no portal lets in, has
/// at least a quarter.
constexpr double kMostAimed = 0.75, kLeastAimed = 0.5;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// --- Rays in a room ------------------------------------------------------------------------------

constexpr uint32_t kRaysOfPoint = 4;

/// Without those from points that lie in the open: what is outside of a room.
Feelers withoutOutside(const Feelers& feelers) {
    Feelers inside;
    for (size_t first = 0; first < feelers.size(); first += kRaysOfPoint) {
        const std::span<const Feeler> ofPoint = std::span(feelers).subspan(first, kRaysOfPoint);
        if (shareOfFree(ofPoint) <= 0.5)
            inside.insert(inside.end(), ofPoint.begin(), ofPoint.end());
    }
    return inside;
}

/// From what the camera sees, and from where these rays end; empty where the scene lies open, where
/// nothing sees the sky, or where a larger share of the rays from what the camera sees does than
/// mostFree.
Feelers feelRoom(const WideLayout& bvh, const Camera& camera, const SeesThrough& seesThrough,
                 double mostFree) {
    constexpr uint32_t kSideFirst = 16, kSide = 32;
    constexpr double kOpen = 0.3;
    Random random(1);
    const Feelers few = feelFrom(bvh, lookAround(bvh, camera, kSideFirst, seesThrough),
                                 kRaysOfPoint, random, seesThrough);
    if (shareOfFree(few).value_or(1) > kOpen) return {};
    const Feelers seen = lookAround(bvh, camera, kSide, seesThrough);
    const Feelers once = feelFrom(bvh, seen, kRaysOfPoint, random, seesThrough);
    const double free = shareOfFree(once).value_or(1);
    if (free > std::min(kOpen, mostFree) || free <= 0.0) return {};
    Feelers all = withoutOutside(once);
    const size_t fromSeen = all.size();
    const auto add = [&](std::span<const Feeler> ended) {
        const Feelers more =
            withoutOutside(feelFrom(bvh, ended, kRaysOfPoint, random, seesThrough));
        all.insert(all.end(), more.begin(), more.end());
    };
    add(seen);
    add(seen);
    add(Feelers(all.begin(), all.begin() + std::ptrdiff_t(fromSeen)));
    return all;
}

/// Four standard deviations of where they start.
double sizeOf(std::span<const Feeler> feelers) {
    glm::dvec3 mean(0), square(0);
    for (const Feeler& f : feelers)
        mean += glm::dvec3(f.origin) / double(feelers.size());
    for (const Feeler& f : feelers) {
        const glm::dvec3 d = glm::dvec3(f.origin) - mean;
        square += d * d / double(feelers.size());
    }
    return 4 * std::sqrt(square.x + square.y + square.z);
}

// --- Walls ---------------------------------------------------------------------------------------

/// A plane in which portals may lie. Its points are at * normal + x * across + y * along.
struct Plane {
    glm::dvec3 normal; ///< unit, into the room
    double at;
    glm::dvec3 across{0}, along{0};
    glm::dvec2 lo{kInfinity}, hi{-kInfinity}; ///< of what of it was met
    size_t met = 0;

    glm::dvec2 placeOf(const glm::dvec3& p) const {
        return {glm::dot(p, across), glm::dot(p, along)};
    }
    /// Where a ray goes through it out of the room, if it does.
    std::optional<glm::dvec2> passedBy(const Feeler& f) const {
        const double ahead = glm::dot(normal, glm::dvec3(f.direction));
        if (!(ahead < 0)) return std::nullopt;
        const double height = glm::dot(normal, glm::dvec3(f.origin)) - at;
        if (!(height > 0)) return std::nullopt;
        return placeOf(glm::dvec3(f.origin) - height / ahead * glm::dvec3(f.direction));
    }
    bool holds(const Feeler& f, double thickness) const {
        constexpr double kAlike = 0.9995; // the cosine of 1.8 degrees
        return !f.isFree && glm::dot(normal, glm::dvec3(f.normal)) > kAlike &&
               std::abs(glm::dot(normal, glm::dvec3(f.met)) - at) < thickness;
    }
};

/// Upright axes; those of floors and ceilings along a wall.
void setAxes(std::vector<Plane>& planes) {
    constexpr double kLevel = 0.9;
    const auto wall = std::ranges::find_if(
        planes, [](const Plane& p) { return std::abs(p.normal.y) < 1 - kLevel; });
    const glm::dvec3 beside = wall == planes.end() ? glm::dvec3(0, 0, 1) : wall->normal;
    for (Plane& p : planes) {
        const glm::dvec3 up = std::abs(p.normal.y) < kLevel ? glm::dvec3(0, 1, 0) : beside;
        p.along = glm::normalize(up - glm::dot(up, p.normal) * p.normal);
        p.across = glm::cross(p.along, p.normal);
    }
}

/// Planes that many rays have met, and others behind them, since windows lie in recesses.
std::vector<Plane> wallsAmong(std::span<const Feeler> feelers) {
    constexpr size_t kMostKept = 256;
    constexpr double kLeastMet = 0.004; // of all rays
    const double size = sizeOf(feelers), thickness = 0.003 * size;
    std::vector<Plane> planes;
    for (const Feeler& f : feelers) {
        if (f.isFree || f.normal == glm::vec3(0)) continue;
        const auto home =
            std::ranges::find_if(planes, [&](const Plane& p) { return p.holds(f, thickness); });
        if (home != planes.end())
            ++home->met;
        else if (planes.size() < kMostKept)
            planes.push_back({f.normal, glm::dot(glm::dvec3(f.normal), glm::dvec3(f.met))});
    }
    std::erase_if(
        planes, [&](const Plane& p) { return double(p.met) < kLeastMet * double(feelers.size()); });
    std::ranges::stable_sort(planes, std::greater(), &Plane::met);
    setAxes(planes);
    for (Plane& p : planes)
        for (const Feeler& f : feelers)
            if (p.holds(f, thickness)) {
                p.lo = glm::min(p.lo, p.placeOf(f.met));
                p.hi = glm::max(p.hi, p.placeOf(f.met));
            }
    const size_t walls = planes.size();
    for (size_t i = 0; i < walls; ++i)
        for (const double depth : {0.003, 0.006, 0.012, 0.024, 0.048}) {
            planes.push_back(planes[i]);
            planes.back().at -= depth * size;
        }
    return planes;
}

// --- Openings ------------------------------------------------------------------------------------

struct Opening {
    const Plane* plane;
    glm::dvec2 lo{kInfinity}, hi{-kInfinity};
    double through = 0; ///< free rays that pass it and no opening found before,
    double tried = 0;   ///< and all rays that would if nothing were in their way

    bool holds(const glm::dvec2& p) const {
        return p.x >= lo.x && p.y >= lo.y && p.x <= hi.x && p.y <= hi.y;
    }
    bool isPassedBy(const Feeler& f) const {
        const std::optional<glm::dvec2> p = plane->passedBy(f);
        return p && holds(*p);
    }
};

/// Points of a plane that lie together: their bounding rectangles, in cells of which no gap is
/// wider than `reach`.
std::vector<Opening> groupsOf(const Plane& plane, std::span<const glm::dvec2> points, int reach) {
    constexpr int kCells = 40;
    constexpr int kEmpty = 0, kFilled = -1; // else the number of its group
    glm::dvec2 lo(kInfinity), hi(-kInfinity);
    for (const glm::dvec2& p : points)
        lo = glm::min(lo, p), hi = glm::max(hi, p);
    const glm::dvec2 size = glm::max(hi - lo, glm::dvec2(std::numeric_limits<double>::min()));
    const auto cellOf = [&](const glm::dvec2& p) {
        const glm::ivec2 c = glm::min(glm::ivec2((p - lo) / size * double(kCells)), kCells - 1);
        return size_t(c.y * kCells + c.x);
    };
    std::array<int, size_t(kCells) * kCells> group{};
    for (const glm::dvec2& p : points)
        group[cellOf(p)] = kFilled;
    int count = kEmpty;
    std::vector<int> open;
    for (int first = 0; first < kCells * kCells; ++first) {
        if (group[size_t(first)] != kFilled) continue;
        group[size_t(first)] = ++count;
        open.push_back(first);
        while (!open.empty()) {
            const int cell = open.back(), x = cell % kCells, y = cell / kCells;
            open.pop_back();
            for (int v = std::max(y - reach, 0); v <= std::min(y + reach, kCells - 1); ++v)
                for (int u = std::max(x - reach, 0); u <= std::min(x + reach, kCells - 1); ++u)
                    if (int& g = group[size_t(v * kCells + u)]; g == kFilled) {
                        g = count;
                        open.push_back(v * kCells + u);
                    }
        }
    }
    std::vector<Opening> groups(size_t(count), {&plane});
    for (const glm::dvec2& p : points) {
        Opening& g = groups[size_t(group[cellOf(p)] - 1)];
        g.lo = glm::min(g.lo, p);
        g.hi = glm::max(g.hi, p);
        g.through += 1;
    }
    for (Opening& g : groups) { // the outermost rays lie a little inside of the opening
        const glm::dvec2 margin = (g.hi - g.lo) * (0.01 + 1 / (1 + g.through));
        g.lo -= margin;
        g.hi += margin;
    }
    return groups;
}

/// What openings are worth, by the second moments of light samples: of those that aim at them,
/// uniform over what they take up, and of those by the sky's own density, which finds the rest.
/// That is taken to be twice as good as the same density everywhere, by which the rays were drawn.
struct Worth {
    double through = 0, tried = 0;
    double rest = 0; ///< free rays that pass none,
    double all = 0;  ///< of so many
    /// Of the sky (EnvironmentTable): samples that aim at an opening do not go where the sky is
    /// bright, as the others do.
    double unevenness = 1;

    double aimed() const { return unevenness * through * tried; }
    double others() const { return 0.5 * rest * all; }
    /// Where half of the samples aim at them.
    double secondMoment() const { return 2 * aimed() + 2 * others(); }
    /// The share of samples to aim with which it is least, and how much less it is than without.
    double bestShare() const {
        return std::sqrt(aimed()) / (std::sqrt(aimed()) + std::sqrt(others()));
    }
    /// At most 1, or, if that is more, 1 / (2 unevenness s), s being the share of free rays: the
    /// sum of the roots is concave in `through`, and `tried` is not less.
    double gain() const {
        return 0.5 * (through + rest) * all / std::pow(std::sqrt(aimed()) + std::sqrt(others()), 2);
    }
    Worth with(const Opening& o) const {
        return {through + o.through, tried + o.tried, rest - o.through, all, unevenness};
    }
};

/// The rays of a room.
struct Room {
    std::vector<Plane> planes;
    Feelers free;     ///< those that pass no opening yet
    Feelers some;     ///< of all, one in
    double every = 4; ///< so many
};

/// Free rays that pass the least of openings.
constexpr size_t kLeastThrough = 8;

/// Those of the groups that gain; `worth` becomes what there is with them. passed: where Room::some
/// pass the plane; every: Room::every.
std::vector<Opening> worthwhile(std::vector<Opening> groups, std::span<const glm::dvec2> passed,
                                double every, size_t most, Worth& worth) {
    constexpr double kLeastGain = 1.01;
    std::ranges::stable_sort(groups, std::greater(), &Opening::through);
    std::vector<Opening> chosen;
    for (Opening& o : groups) {
        if (o.through < double(kLeastThrough) || chosen.size() == most) break;
        const auto count =
            std::ranges::count_if(passed, [&](const glm::dvec2& p) { return o.holds(p); });
        o.tried = std::max(every * double(count), o.through);
        if (worth.secondMoment() < kLeastGain * worth.with(o).secondMoment()) continue;
        worth = worth.with(o);
        chosen.push_back(o);
    }
    return chosen;
}

/// Where rays pass a plane.
std::vector<glm::dvec2> placesWhere(std::span<const Feeler> feelers, const Plane& plane) {
    std::vector<glm::dvec2> places;
    for (const Feeler& f : feelers)
        if (const std::optional<glm::dvec2> p = plane.passedBy(f)) places.push_back(*p);
    return places;
}

/// The openings in one of the planes that gain most.
std::vector<Opening> bestOpenings(const Room& room, size_t most, Worth& worth) {
    std::vector<std::vector<Opening>> best(room.planes.size());
    std::vector<Worth> with(room.planes.size(), worth);
    tbb::parallel_for(size_t(0), room.planes.size(), [&](size_t i) {
        const Plane& plane = room.planes[i];
        std::vector<glm::dvec2> points = placesWhere(room.free, plane);
        std::erase_if(points,
                      [&](const glm::dvec2& p) { return p != glm::clamp(p, plane.lo, plane.hi); });
        if (points.size() < kLeastThrough) return; // nothing in most planes
        const std::vector<glm::dvec2> passed = placesWhere(room.some, plane);
        for (const int reach : {1, 2, 4, 8}) {
            Worth of = worth;
            std::vector<Opening> openings =
                worthwhile(groupsOf(plane, points, reach), passed, room.every, most, of);
            if (of.secondMoment() >= with[i].secondMoment()) continue;
            with[i] = of;
            best[i] = std::move(openings);
        }
    });
    const auto found = std::ranges::min_element(with, {}, &Worth::secondMoment);
    if (found == with.end()) return {};
    worth = *found;
    return best[size_t(found - with.begin())];
}

Portal portalOf(const Opening& o) {
    const Plane& p = *o.plane;
    const glm::dvec2 size = o.hi - o.lo;
    return {glm::vec3(p.at * p.normal + o.lo.x * p.across + o.lo.y * p.along),
            glm::vec3(size.x * p.across), glm::vec3(size.y * p.along)};
}

} // namespace

Portals findPortals(const WideLayout& bvh, const Camera& camera, double unevenness,
                    const SeesThrough& seesThrough) {
    constexpr double kLeastGain = 1.25;
    constexpr size_t kLeastFree = 64;
    // Twice the share with which portals may pay (Worth::gain()), as that of all rays may be
    // smaller than that of the first ones: in four rooms it is 0.8 to 1.2 times as large.
    const double mostFree = 2 / (2 * unevenness * kLeastGain);
    const Feelers feelers = feelRoom(bvh, camera, seesThrough, mostFree);
    Room room;
    std::ranges::copy_if(feelers, std::back_inserter(room.free), &Feeler::isFree);
    if (room.free.size() < kLeastFree) return {};
    room.planes = wallsAmong(feelers);
    for (size_t i = 0; i < feelers.size(); i += size_t(room.every))
        room.some.push_back(feelers[i]);

    Worth worth{
        .rest = double(room.free.size()), .all = double(feelers.size()), .unevenness = unevenness};
    Portals found;
    while (found.all.size() < kMostPortals) {
        const std::vector<Opening> openings =
            bestOpenings(room, kMostPortals - found.all.size(), worth);
        if (openings.empty()) break;
        for (const Opening& o : openings) {
            found.all.push_back(portalOf(o));
            std::erase_if(room.free, [&](const Feeler& f) { return o.isPassedBy(f); });
        }
    }
    if (found.all.empty() || worth.gain() < kLeastGain) return {};
    found.share = std::clamp(worth.bestShare(), kLeastAimed, kMostAimed);
    return found;
}

Portals statedPortals(std::span<const Portal> portals, const Camera& camera) {
    Portals stated{{}, kMostAimed};
    for (Portal p : portals.first(std::min(portals.size(), kMostPortals))) {
        const glm::dvec3 normal = glm::cross(glm::dvec3(p.edgeA), glm::dvec3(p.edgeB));
        if (glm::dot(normal, camera.position - glm::dvec3(p.corner)) < 0)
            std::swap(p.edgeA, p.edgeB);
        stated.all.push_back(p);
    }
    return stated;
}

std::array<glm::vec4, gpu::PORTAL_ROWS * gpu::MOST_PORTALS>
portalRows(std::span<const Portal> portals) {
    static_assert(gpu::MOST_PORTALS == kMostPortals);
    std::array<glm::vec4, gpu::PORTAL_ROWS * gpu::MOST_PORTALS> rows{};
    for (size_t i = 0; i < portals.size(); ++i) {
        const Portal& p = portals[i];
        const glm::vec3 half = 0.5f * (p.edgeA + p.edgeB);
        glm::vec4* row = &rows[gpu::PORTAL_ROWS * i];
        row[0] = glm::vec4(p.corner, 0);
        row[1] = glm::vec4(p.edgeA, 1 / glm::dot(p.edgeA, p.edgeA));
        row[2] = glm::vec4(p.edgeB, 1 / glm::dot(p.edgeB, p.edgeB));
        row[3] = glm::vec4(glm::cross(p.edgeA, p.edgeB), glm::length(half));
        row[4] = glm::vec4(half, 0);
    }
    return rows;
}

} // namespace stromboli
