#pragma once

#include "host/cli/options.hpp"
#include "host/core/system.hpp"
#include "host/engine/load_scene.hpp"
#include "host/render/sampling_session.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace stromboli {

// --- The status line -----------------------------------------------------------------------------

/// The line at the bottom of a terminal that is redrawn in place and says what goes on. There is
/// none where standard error is no terminal, or one that cannot move its cursor (TERM=dumb), and
/// none before allow(). Every thread may draw; messages clear it before they appear
/// (setUpLogging).
namespace status_line {

/// Whether the user wants to see one.
void allow(bool wanted);
bool isShown();
/// Draws the text, cut to the width of the terminal, in place of what is there.
void draw(std::string_view text);
void clear();
/// What clear() writes: back to the first column, and the rest of the line is erased.
inline constexpr const char* kErase = "\r\033[K";

} // namespace status_line

// --- Activity ------------------------------------------------------------------------------------

/// Who draws the status line.
enum class StatusLine {
    OfActivity, ///< what is being done, and for how many seconds
    OfOthers    ///< somebody who knows more
};

/// What the program is busy with, for the status line and for the message of a signal that ends it:
/// "loading cornell.dae". Replaces what was said before.
void nowDoing(const std::string& what, StatusLine line = StatusLine::OfActivity);

/// What nowDoing() said last; empty if a thread is just about to change it.
std::string whatIsBeingDone();

/// Draws the status line anew if something has been done for a while. Called a few times a second
/// by the thread that watches for signals, because those who work do not know how long it takes.
void redrawActivity();

/// What an engine says becomes messages, and what it does the activity.
Listener toTerminal();

// --- Progress ------------------------------------------------------------------------------------

/// Foretells when something is done from how it has gone on since the first news of it: what came
/// before, as the compilation of a kernel, says nothing about the rest.
class TimeLeft {
  public:
    /// After `seconds` the share `done` of all is done. Empty as long as there is too little to
    /// tell from.
    std::optional<double> after(double seconds, double done);

  private:
    std::optional<double> firstSeconds_;
    double firstShare_ = 0;
};

/// "12.5 %, 0.30 M samples in 1.0 s, 7.0 s left".
std::string progressInWords(const RenderProgress& progress, double seconds,
                            std::optional<double> secondsLeft);
/// An object without a line's end: share (0 to 1), samples, rays, seconds, secondsLeft (null: not
/// known yet).
std::string progressAsJson(const RenderProgress& progress, double seconds,
                           std::optional<double> secondsLeft);

/// Says how far a render is: in the status line at most four times a second, or as lines.
class ProgressBar {
  public:
    explicit ProgressBar(ProgressRequest request = {}) : request_(request) {}
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void show(const RenderProgress& progress);

  private:
    ProgressRequest request_;
    Stopwatch watch_;
    TimeLeft left_;
    double lastShown_ = 0;                   ///< seconds
    std::optional<RenderProgress> notShown_; ///< since then
};

/// "850 ms", "12.3 s", "4 min 05 s", "2 h 03 min".
std::string formatDuration(double seconds);

} // namespace stromboli
