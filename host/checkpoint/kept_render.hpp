#pragma once

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/stopwatch.hpp"
#include "host/film/film.hpp"
#include "host/render/render_session.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace stromboli {

/// Makes the backend of the settings, or makes one ready for them that others hold too; `again`:
/// the last one's device was lost.
using MakeBackend = std::function<std::shared_ptr<Backend>(const RenderSettings&, bool again)>;

/// A render whose state is put into a file now and then.
struct KeptRender {
    /// Asked for when the first checkpoint is written: most renders write none, and to read the
    /// whole scene and program for one takes time.
    std::function<RenderIdentity()> identity;
    RenderSettings settings;
    std::optional<SessionState> begun; ///< goes on from there
    std::filesystem::path file;        ///< empty: nowhere
    double everySeconds = 60;          ///< from one checkpoint to the next, and to the first
    bool keepsAtEnd = false;           ///< else the file is removed when the render is finished
};

/// What came of it.
struct KeptOutcome {
    Film film;
    RenderOutcome outcome;
    RenderCounters counters;         ///< of this run
    double prepareSeconds = 0;       ///< making backends
    double renderSeconds = 0;        ///< passes, with the checkpoints between them
    bool stopped = false;            ///< by `progress`
    bool fileIsThere = false;        ///< one can go on from it
    std::optional<std::string> lost; ///< what the device said when it was lost for the second time
};

/// Renders until the plan is content, `progress` says stop, or the device is lost twice. After the
/// first time a new backend goes on from the last checkpoint, or from the beginning where there is
/// none; `say` gets a line about it. What was sampled before a stop or a second loss is in the
/// film. Throws OutputError if a checkpoint cannot be written before there is one.
KeptOutcome renderKept(const KeptRender& render, const MakeBackend& makeBackend,
                       const ProgressCallback& progress,
                       const std::function<void(const std::string&)>& say);

} // namespace stromboli
