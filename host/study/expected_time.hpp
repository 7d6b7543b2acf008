#pragma once

#include "host/study/study.hpp"

#include <map>

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
    /// Of what is not done yet; none before anything is known.
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

} // namespace stromboli::study
