#pragma once

#include "host/core/stopwatch.hpp"
#include "host/render/render.hpp"

namespace stromboli {

/// Ctrl-C: the first one asks the render to stop and write what it has, a second one ends the
/// program at once.
void watchForInterrupt();
bool interrupted();
inline constexpr int kInterruptedExitCode = 130; ///< as a shell reports SIGINT

/// A line on standard error that shows how far a render is, redrawn in place: only on a terminal,
/// at most four times a second.
class ProgressBar {
  public:
    explicit ProgressBar(bool wanted);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void show(const RenderProgress& progress);

  private:
    bool shown_;
    Stopwatch watch_;
    double lastShown_ = -1; ///< seconds
    bool drawn_ = false;
};

/// "850 ms", "12.3 s", "4 min 05 s", "2 h 03 min".
std::string formatDuration(double seconds);

} // namespace stromboli
