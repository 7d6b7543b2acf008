#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stromboli {

/// How much of a pass each of several backends takes next, by their speeds so far, so that all of
/// them end at about the same time: guided self-scheduling (Polychronopoulos and Kuck 1987) with
/// weights.
class PiecePlan {
  public:
    /// leastSeconds: what a piece takes at least. At the end a backend waits for about as long.
    PiecePlan(size_t members, double leastSeconds);

    /// Samples for a member that has nothing to do, of `left` (at least 1) that nobody has taken:
    /// half of its share of what is left, but not what should take four times as long as its last
    /// piece: of so much less work its speed is a poor guess.
    uint64_t next(size_t member, uint64_t left) const;

    /// The member has taken so many samples in that time.
    void took(size_t member, uint64_t samples, double seconds);
    /// The member takes no more.
    void dropOut(size_t member);

  private:
    struct Pace {
        double samples = 0, seconds = 0; ///< what was long ago counts for less
        double lastSeconds = 0;          ///< of its last piece
        bool isOut = false;

        bool isKnown() const { return samples > 0 && seconds > 0; }
        double speed() const { return samples / seconds; }
    };

    double speedOfAll() const;

    std::vector<Pace> paces_;
    double leastSeconds_;
};

} // namespace stromboli
