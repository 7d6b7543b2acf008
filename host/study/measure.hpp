#pragma once

#include "host/compare/metrics.hpp"
#include "host/render/backend.hpp"
#include "host/render/settings.hpp"
#include "host/study/study.hpp"

#include <functional>
#include <map>
#include <memory>

namespace stromboli::study {

/// Foretells what is left of a study from what is done: a run takes as long as the same
/// configuration took before in the scene, or else the mean of all runs of the scene, or of all;
/// a reference as long as its samples at the pace of the first run, or of the other references.
class ExpectedTime {
  public:
    explicit ExpectedTime(const Study& study);

    /// Wall time from the preparation to the end.
    void runTook(const std::string& scene, const std::string& configuration, double seconds);
    /// `making`: what it took when it was made, which is longer if it was read from a file.
    void referenceTook(double seconds, double making);
    /// Expected time of what is not done yet; none before anything is known.
    std::optional<double> secondsLeft() const;
    double secondsDone() const { return done_; }
    /// Expected time of one run; none before anything is known.
    std::optional<double> runSeconds(const std::string& scene,
                                     const std::string& configuration) const;
    std::optional<double> referenceSeconds() const;

  private:
    struct Mean {
        double sum = 0;
        int count = 0;
        void add(double seconds) { sum += seconds, ++count; }
    };
    std::map<std::pair<std::string, std::string>, int> runsLeft_;
    std::map<std::pair<std::string, std::string>, Mean> runs_;
    std::map<std::string, Mean> scenes_;
    Mean all_, references_;
    int referencesLeft_ = 0;
    double referenceOverRun_ = 1; ///< samples of a reference over those of a run
    double done_ = 0;
};

/// A picture, and what it took from the first sample on.
struct MeasuredPicture {
    Film film;          ///< of a denoised picture, with its means
    PictureNoise noise; ///< as the render states it
    double wallSeconds = 0, cpuSeconds = 0;
    uint64_t rays = 0;
};

/// A render that is ready to start: scene loaded, kernel built.
struct PreparedRender {
    std::shared_ptr<void> scene; ///< whatever the backend needs as long as it lives
    RenderSettings settings;
    std::unique_ptr<Backend> backend;
    /// In place of the backend, where a denoiser is asked for: takes all samples and denoises.
    /// Empty: stopped, as progress() said by false.
    std::function<std::optional<MeasuredPicture>(const std::function<bool()>& progress)> denoised;
};

/// Makes a render of a scene by the options of `stromboli render`. Throws Error.
using Prepare = std::function<PreparedRender(const std::string& scene,
                                             const std::vector<std::string>& options)>;

/// Called while samples are taken, with the seconds since the run began; false stops the run.
using KeepGoing = std::function<bool(double seconds)>;
/// Every picture of a run.
using TakeFilm = std::function<void(const Point&, const Film&)>;

/// Where and with what a run is measured.
struct RunPlan {
    std::string scene;
    const Configuration& configuration;
    uint32_t seed = 0;
    const StudySettings& settings;
    const compare::Picture& reference;
};

/// Takes the pictures of one run. Sample counts grow within one render, each continuing the last;
/// other efforts are renders of their own. Each kernel first takes one sample that is thrown away,
/// so that the driver's compilation is not in the times. Empty: stopped by `keepGoing`.
std::optional<Run> measureRun(const RunPlan& plan, const Prepare& prepare,
                              const KeepGoing& keepGoing, const TakeFilm& takeFilm);

/// The options of one render, in full.
std::vector<std::string> renderOptions(const StudySettings& settings, const Configuration& c,
                                       double step, uint32_t seed, uint32_t samples);

/// Compares a film with the reference; all of the point but the effort and the times.
Point pointOf(const Film& film, const compare::Picture& reference);

} // namespace stromboli::study
