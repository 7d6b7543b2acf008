#pragma once

#include "host/checkpoint/kept_render.hpp"
#include "host/cli/job.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// The checkpoint that a render goes on from, if it does.
struct Begun {
    std::string file; ///< where checkpoints go; empty: nowhere
    /// Of the whole picture, or of the first band that has one.
    std::optional<Checkpoint> checkpoint;
    uint32_t bands = 0; ///< checkpoints are of so many bands, each in its bandFile(); 0: of no band
};

/// Reads the checkpoint where --resume asks for it. Says so, and begins anew, if there is none.
/// Throws UsageError if it cannot be used.
Begun takeUp(const Options& options);

/// With what has to be as it was when the render began and is not asked for otherwise. Throws
/// UsageError if that does not go together.
Options optionsToGoOn(Options options, const Begun& begun);

/// The bands to render, of at most so many pixels each; where checkpoints are of bands, the same
/// ones. Throws UsageError if what was begun does not fit.
std::vector<PictureArea> bandsToRender(const PictureArea& area, uint64_t mostPixels,
                                       const Begun& begun);

/// What a band goes on from.
Begun begunBand(const Begun& begun, size_t band, size_t count);

/// Removes the checkpoints of an earlier render in the place of those of this one, of `bands`
/// bands.
void forgetEarlier(const std::string& file, size_t bands);

/// The render of a job, which must outlive it, or of a band of it, by its settings. Throws
/// UsageError if the checkpoint is of another one.
KeptRender keptRender(const Job& job, const RenderSettings& settings, const Options& options,
                      const Begun& begun, const std::string& device);

} // namespace stromboli
