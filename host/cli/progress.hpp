#pragma once

#include "host/core/system.hpp"
#include "host/render/sampling_session.hpp"

#include <optional>
#include <string>

namespace stromboli {

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

/// Shows in the status line how far a render is, at most four times a second.
class ProgressBar {
  public:
    ProgressBar() = default;
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    void show(const RenderProgress& progress);

  private:
    Stopwatch watch_;
    TimeLeft left_;
    std::optional<double> lastShown_; ///< seconds
};

/// "850 ms", "12.3 s", "4 min 05 s", "2 h 03 min".
std::string formatDuration(double seconds);

} // namespace stromboli
