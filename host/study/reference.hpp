#pragma once

#include "host/compare/picture.hpp"
#include "host/study/measure.hpp"

#include <filesystem>

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

} // namespace stromboli::study
