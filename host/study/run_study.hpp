#pragma once

#include "host/compare/metrics.hpp"
#include "host/study/measure.hpp"

#include <filesystem>
#include <functional>

namespace stromboli::study {

/// A long render to measure errors against, kept as an EXR file with its variances: `folder` /
/// `name`.exr. One that is there with at least as many samples, made by the same options, is used
/// again. Empty: stopped by `keepGoing`, which gets the share that is done in place of seconds.
/// Fills in scene.reference.
/// Throws Error.
std::optional<compare::Picture> referencePicture(const std::filesystem::path& folder,
                                                 const std::string& name,
                                                 const StudySettings& settings,
                                                 const Prepare& prepare, const KeepGoing& keepGoing,
                                                 SceneStudy& scene);

/// relMSE that a film's own noise gives it, from the variances of its pixels, and the standard
/// error of its mean over its mean.
void describeError(const compare::Picture& picture, Reference& reference);

/// How far a study is; shown now and then.
struct StudyProgress {
    std::string doing;                 ///< "cornell_boxes: hemisphere, seed 2 of 4"
    double share = 0;                  ///< of the whole study's expected time, in [0, 1]
    std::optional<double> secondsLeft; ///< unknown before anything is measured
};

struct StudyHooks {
    Prepare prepare;
    std::function<void(const StudyProgress&)> show;
    std::function<bool()> stopped; ///< asked often
};

/// Measures what `study` does not have yet, and writes study.json in `folder` after every run, so
/// that a study that is stopped can go on; references go to its folder references, pictures of
/// the first seed to pictures. False if it was stopped. Throws Error.
bool runStudy(const std::filesystem::path& folder, Study& study, const StudyHooks& hooks);

/// Files of a picture that a run took, without extension, in the study's folder.
std::string pictureName(const std::string& scene, const std::string& configuration,
                        size_t effortIndex);

} // namespace stromboli::study
