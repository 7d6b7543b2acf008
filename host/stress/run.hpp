#pragma once

#include "host/stress/subject.hpp"

#include <functional>

namespace stromboli::stress {

enum class Amount {
    Quick, ///< enough to find gross faults, in a second or two a case
    Full,
};

/// Thrown out of a case when the user wants it to stop.
struct Interrupted {};

/// What a case works with.
class Run {
  public:
    /// `goOn` is asked often; false from it ends the case.
    Run(Subject& subject, Amount amount, std::function<bool()> goOn = {})
        : subject_(subject), amount_(amount), goOn_(std::move(goOn)) {}

    Subject& subject() const { return subject_; }
    bool quick() const { return amount_ == Amount::Quick; }
    template <class T>
    T amount(T whenQuick, T whenFull) const {
        return quick() ? whenQuick : whenFull;
    }

    /// Throws Interrupted if the user wants no more.
    void goOn() const {
        if (goOn_ && !goOn_()) throw Interrupted{};
    }
    /// Throws Interrupted.
    Picture render(const Scene& scene, const Camera& camera, const RenderSettings& settings,
                   const KernelTuning& tuning = {}) const;

  private:
    Subject& subject_;
    Amount amount_;
    std::function<bool()> goOn_;
};

} // namespace stromboli::stress
