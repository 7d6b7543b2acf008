#include "host/study/expected_time.hpp"

namespace stromboli::study {

ExpectedTime::ExpectedTime(const Study& study)
    : referencesLeft_(int(study.scenes.size())),
      referenceOverRun_(double(study.settings.referenceSamples) /
                        double(study.settings.sampleCounts.back())) {
    for (const SceneStudy& scene : study.scenes) {
        for (const Configuration& c : study.settings.configurations)
            runsLeft_[{scene.name, c.name}] = int(study.settings.seeds);
        for (const Run& run : scene.runs)
            --runsLeft_[{scene.name, run.configuration}];
    }
}

void ExpectedTime::runTook(const std::string& scene, const std::string& configuration,
                           double seconds) {
    --runsLeft_[{scene, configuration}];
    runs_[{scene, configuration}].add(seconds);
    scenes_[scene].add(seconds);
    all_.add(seconds);
    done_ += seconds;
}

void ExpectedTime::referenceTook(double seconds, double making) {
    --referencesLeft_;
    references_.add(making);
    done_ += seconds;
}

std::optional<double> ExpectedTime::runSeconds(const std::string& scene,
                                               const std::string& configuration) const {
    const auto mean = [](const Mean& m) { return m.sum / m.count; };
    if (const auto run = runs_.find({scene, configuration}); run != runs_.end())
        return mean(run->second);
    if (const auto found = scenes_.find(scene); found != scenes_.end()) return mean(found->second);
    if (all_.count > 0) return mean(all_);
    if (references_.count > 0) return mean(references_) / referenceOverRun_;
    return std::nullopt;
}

std::optional<double> ExpectedTime::referenceSeconds() const {
    if (references_.count > 0) return references_.sum / references_.count;
    if (all_.count > 0) return referenceOverRun_ * all_.sum / all_.count;
    return std::nullopt;
}

std::optional<double> ExpectedTime::secondsLeft() const {
    double left = 0;
    for (const auto& [name, count] : runsLeft_) {
        if (count <= 0) continue;
        const auto seconds = runSeconds(name.first, name.second);
        if (!seconds) return std::nullopt;
        left += count * *seconds;
    }
    if (referencesLeft_ > 0) {
        const auto seconds = referenceSeconds();
        if (!seconds) return std::nullopt;
        left += referencesLeft_ * *seconds;
    }
    return left;
}

} // namespace stromboli::study
