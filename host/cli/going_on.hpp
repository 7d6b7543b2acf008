#pragma once

#include "host/checkpoint/kept_render.hpp"
#include "host/cli/job.hpp"

#include <optional>
#include <string>

namespace stromboli {

/// The checkpoint that a render goes on from, if it does.
struct Begun {
    std::string file; ///< where checkpoints go; empty: nowhere
    std::optional<Checkpoint> checkpoint;
};

/// Reads the checkpoint where --resume asks for it. Says so, and begins anew, if there is none.
/// Throws UsageError if it cannot be used.
Begun takeUp(const Options& options);

/// With what has to be as it was when the render began and is not asked for otherwise. Throws
/// UsageError if that does not go together.
Options optionsToGoOn(Options options, const Begun& begun);

/// Says that the picture is rendered in bands, which keep no checkpoints. Throws UsageError where
/// one is asked for.
void sayBands(size_t bands, const Options& options, const Begun& begun);

/// The render of a job, which must outlive it, or of a band of it, by its settings. Throws
/// UsageError if the checkpoint is of another one.
KeptRender keptRender(const Job& job, const RenderSettings& settings, const Options& options,
                      const Begun& begun, const std::string& device);

} // namespace stromboli
