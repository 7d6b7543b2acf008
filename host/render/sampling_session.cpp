#include "host/render/sampling_session.hpp"

#include "host/render/render.hpp"

#include <algorithm>
#include <limits>

namespace stromboli {

SamplingSession::SamplingSession(Backend& backend, const RenderSettings& settings)
    : backend_(backend), settings_(settings), plan_(settings.budget),
      noisePlan_(settings.budget.mostSamplesPerPixel, settings.estimator.branches,
                 settings.budget.stop.seconds > 0 ? NoisePlan::Beginning::CoarseToFine
                                                  : NoisePlan::Beginning::AllAlike),
      film_(settings.area) {
    film_.branches = settings.estimator.branches;
}

SamplingSession::SamplingSession(Backend& backend, const SessionState& saved)
    : SamplingSession(backend, saved.settings) {
    backend_.restoreBlocks(saved.blocks);
    backend_.restoreAll(saved.sums, film_);
    estimate_.remember(saved.estimate);
    pending_ = saved.pending;
    secondsBefore_ = saved.secondsUsed;
    countSamples();
}

void SamplingSession::countSamples() {
    samplesDone_ = 0;
    for (const PixelStatistics& p : film_.pixels)
        samplesDone_ += p.taken();
}

bool SamplingSession::pass(const ProgressCallback& progress) {
    if (!watch_) watch_.emplace();
    if (timeIsUp()) return false;
    if (pending_.empty()) pending_ = nextPass();
    if (pending_.empty()) return false;
    bool goesOn = true;
    sample(progress, goesOn);
    if (isComplete(pending_)) {
        // One sample tells no error; two do, without what was before them.
        if (pending_.front().samples > 1) estimate_.update(film_);
        pending_.clear();
    } else {
        countSamples(); // a backend that is stopped may end some more than it has told of
    }
    return goesOn && !timeIsUp();
}

std::vector<PixelTarget> SamplingSession::nextPass() const {
    const Budget& budget = settings_.budget;
    if (!budget.spreads()) return plan_.next(film_);
    return noisePlan_.next(film_, estimate_, samplesLeft(), budget.stop.noise);
}

void SamplingSession::sample(const ProgressCallback& progress, bool& goesOn) {
    RenderProgress state;
    state.samplesAtMost = samplesAtMost(settings_.area, settings_.budget);
    const uint64_t before = samplesDone_, expected = expectedSamples();
    const double seconds = settings_.budget.stop.seconds;
    backend_.sample(pending_, film_, [&](uint64_t done) {
        samplesDone_ = before + done;
        state.samplesDone = samplesDone_;
        state.counters = backend_.counters();
        state.share = std::max(seconds > 0 ? secondsUsed() / seconds : 0,
                               double(samplesDone_) / double(expected));
        if (progress && goesOn) goesOn = progress(state);
        return goesOn && !timeIsUp();
    });
}

bool SamplingSession::isComplete(const std::vector<PixelTarget>& pass) const {
    return std::all_of(pass.begin(), pass.end(), [&](const PixelTarget& t) {
        return film_.pixels[t.pixel].taken() >= t.samples;
    });
}

bool SamplingSession::timeIsUp() const {
    const double seconds = settings_.budget.stop.seconds;
    return seconds > 0 && secondsUsed() >= seconds;
}

/// Samples that the budget still has, as to time at the rate so far, or one a pixel while there is
/// none.
uint64_t SamplingSession::samplesLeft() const {
    const Budget& budget = settings_.budget;
    const uint64_t all = budget.meanSamplesPerPixel > 0
                             ? film_.pixels.size() * uint64_t(budget.meanSamplesPerPixel)
                             : std::numeric_limits<uint64_t>::max();
    const uint64_t left = all - std::min(samplesDone_, all);
    if (budget.stop.seconds == 0) return left;
    const double used = secondsUsed();
    if (samplesDone_ == 0 || used == 0) return std::min(left, uint64_t(film_.pixels.size()));
    const double remaining = std::max(budget.stop.seconds - used, 0.0);
    return std::min(left, uint64_t(remaining * double(samplesDone_) / used));
}

/// In all: if the noise is to fall from where it is now to the one asked for, as 1 / sqrt(n).
uint64_t SamplingSession::expectedSamples() const {
    const uint64_t atMost = samplesAtMost(settings_.area, settings_.budget);
    const double target = settings_.budget.stop.noise;
    if (target == 0 || samplesDone_ == 0) return atMost;
    const PictureNoise reached = estimate_.picture(film_);
    if (!reached.known() || reached.most <= target) return atMost;
    const double ratio = reached.most / target;
    const double expected = double(samplesDone_) * ratio * ratio;
    return expected < double(atMost) ? uint64_t(expected) + 1 : atMost;
}

RenderOutcome SamplingSession::outcome() const {
    if (pending_.empty()) return {estimate_.picture(film_), timeIsUp()};
    NoiseEstimate now = estimate_; // the pass that was stopped has changed some pixels
    now.update(film_);
    return {now.picture(film_), timeIsUp()};
}

SessionState SamplingSession::save() const {
    return {
        settings_,    backend_.saveAll(film_), backend_.saveBlocks(), estimate_.memory(), pending_,
        secondsUsed()};
}

} // namespace stromboli
