#include "host/render/piece_plan.hpp"

#include <algorithm>

namespace stromboli {
namespace {

/// The first piece of a member whose speed nobody knows is so small a part of an equal share that
/// one which is a hundred times slower than the others does not keep them waiting.
constexpr double kFirstPart = 1.0 / 256;

/// From one piece of a member to the next, in time.
constexpr double kGrowth = 4;

} // namespace

PiecePlan::PiecePlan(size_t members, double leastSeconds)
    : paces_(members), leastSeconds_(leastSeconds) {}

/// Of all members; one whose speed nobody knows is like the others.
double PiecePlan::speedOfAll() const {
    double speed = 0;
    size_t known = 0, count = 0;
    for (const Pace& p : paces_) {
        if (p.isOut) continue;
        ++count;
        if (!p.isKnown()) continue;
        speed += p.speed();
        ++known;
    }
    return speed * double(count) / double(known);
}

uint64_t PiecePlan::next(size_t member, uint64_t left) const {
    const Pace& own = paces_[member];
    double wanted = double(left) * kFirstPart / double(paces_.size());
    if (own.isKnown()) {
        const double halfOfTheRest = double(left) / speedOfAll() / 2;
        wanted = own.speed() *
                 std::min(std::max(halfOfTheRest, leastSeconds_), kGrowth * own.lastSeconds);
    }
    return std::clamp<uint64_t>(uint64_t(std::min(wanted, double(left))), 1, left);
}

void PiecePlan::took(size_t member, uint64_t samples, double seconds) {
    Pace& p = paces_[member];
    p.samples = p.samples / 2 + double(samples);
    p.seconds = p.seconds / 2 + seconds;
    p.lastSeconds = seconds;
}

void PiecePlan::dropOut(size_t member) {
    paces_[member].isOut = true;
}

} // namespace stromboli
