#pragma once

#include "host/checkpoint/kept_render.hpp"
#include "host/cli/job.hpp"
#include "host/cli/report.hpp"
#include "host/farm/round_plan.hpp"

#include <functional>
#include <optional>
#include <string>

namespace stromboli {

/// A word for scene, camera and program: another word, another picture.
std::string fingerprintOf(const Job& job);
/// Throws SceneError, or UsageError for the program, if --expect names another one.
void requireExpected(const Job& job, const Options& options);

/// A film of the whole picture, before it has samples.
FilmHeader headerOfPicture(const Job& job, const Options& options, const std::string& device);
/// The share that is asked for: of the first round, in which no pixel is named, or of a plan. Says
/// so if it has no samples. Throws UsageError if the plan is of another picture.
PlannedShare shareToTake(const Job& job, const Options& options,
                         const std::optional<RoundPlan>& plan, const std::string& device);

/// Whether the film is there already, from an earlier run: --resume asks for it. What cannot be
/// read is said and taken anew. Throws UsageError if it is of another picture or share.
bool isThereAlready(const FilmHeader& header, const Options& options);

/// Takes the samples of the share, band by band of at most so many pixels, and writes its film: all
/// of it or, where it is interrupted, none. Throws DeviceError, OutputError.
void takeShare(const Job& job, const Options& options, const PlannedShare& share,
               const MakeBackend& makeBackend, const std::function<Viewer*()>& viewer,
               uint64_t mostPixels, RenderReport& report);

} // namespace stromboli
