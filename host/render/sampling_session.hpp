#pragma once

#include "host/core/system.hpp"
#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/picture_noise.hpp"
#include "host/render/sampling_plan.hpp"
#include "host/render/settings.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- The state of a render -----------------------------------------------------------------------

/// A render that has been stopped, as a plain value: all that a session needs to go on, apart from
/// the scene, the camera and the device.
struct SessionState {
    RenderSettings settings;
    KeptPixels pixels;                   ///< as Backend::saveAll gives them
    std::vector<ExactStatistics> blocks; ///< as Backend::saveBlocks gives them
    NoiseEstimate::Memory estimate;      ///< of the passes that are done
    std::vector<PixelTarget> pending; ///< of the pass that was stopped; empty: between two passes
    double secondsUsed = 0;           ///< of StopRule::seconds
};

/// Whether they take the same samples.
bool sameEstimator(const Estimator& a, const Estimator& b);

/// For a file. Of this version and byte order of the program.
std::vector<std::byte> toBytes(const SessionState& state);
/// Throws UsageError if the bytes are damaged, cut short or of another version.
SessionState sessionFromBytes(std::span<const std::byte> bytes);

// --- Sessions ------------------------------------------------------------------------------------

/// State of a render for a progress display.
struct RenderProgress {
    uint64_t samplesDone = 0;
    uint64_t samplesAtMost = 0; ///< adaptive renders need fewer
    RenderCounters counters;    ///< of the backend
    double share = 0; ///< of the work that is done, by samples or, if less is allowed, by time
};

/// Returns false to stop the render early.
using ProgressCallback = std::function<bool(const RenderProgress&)>;

/// How far a render has come.
struct RenderOutcome {
    PictureNoise noise;
    bool outOfTime = false; ///< StopRule::seconds ended it
};

/// A picture in the making. It goes on pass by pass; between passes, and after one that was
/// stopped, it can be looked at, saved, and gone on with. However often it is stopped, saved and
/// restored, the film in the end has the same bytes (unless time limits the render).
class SamplingSession {
  public:
    /// The backend was made for these settings, has taken no sample yet, and outlives the session.
    SamplingSession(Backend& backend, const RenderSettings& settings);
    /// Goes on where a session was saved; the backend was made for its settings, by the same kind
    /// of backend, scene and camera. Throws std::invalid_argument if the film is of another size.
    SamplingSession(Backend& backend, const SessionState& saved);

    /// Takes the samples of the next pass, or those that a stopped pass still lacks. False if there
    /// is nothing more to do, if `progress` said stop, or if the time is up.
    bool pass(const ProgressCallback& progress = {});

    /// The picture so far.
    const Film& film() const { return film_; }
    Film takeFilm() && { return std::move(film_); }
    RenderOutcome outcome() const;
    /// Whether no sample is missing of a pass that has begun.
    bool isBetweenPasses() const { return pending_.empty(); }
    /// Estimates of the squared errors of the film's means, by pixel and channel (NoiseEstimate).
    std::vector<glm::dvec3> squaredErrors() const;
    uint64_t samplesDone() const { return samplesDone_; }

    SessionState save() const;

  private:
    std::vector<PixelTarget> nextPass() const;
    NoiseEstimate estimateNow() const;
    void sample(const ProgressCallback& progress, bool& goesOn);
    void countSamples();
    bool isComplete(const std::vector<PixelTarget>& pass) const;
    double secondsUsed() const { return secondsBefore_ + (watch_ ? watch_->seconds() : 0); }
    bool timeIsUp() const;
    uint64_t samplesLeft() const;
    uint64_t expectedSamples() const;

    Backend& backend_;
    RenderSettings settings_;
    SamplingPlan plan_;
    NoisePlan noisePlan_;
    NoiseEstimate estimate_; ///< of the passes that are complete
    Film film_;
    std::vector<PixelTarget> pending_; ///< the pass under way; empty: between two passes
    uint64_t samplesDone_ = 0;
    double secondsBefore_ = 0;       ///< of the sessions that this one continues
    std::optional<Stopwatch> watch_; ///< since the first pass began
};

// --- Renders in one go ---------------------------------------------------------------------------

/// The most samples a render of this budget takes.
uint64_t samplesAtMost(const PictureArea& area, const Budget& budget);

/// Takes all samples of a picture, in a session of its own: pass by pass until the sampling plan is
/// content.
Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress = {},
            RenderOutcome* outcome = nullptr);

} // namespace stromboli
