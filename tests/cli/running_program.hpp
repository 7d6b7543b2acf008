#pragma once

#include "tests/cli/program.hpp"

#include <sys/types.h>

#include <string>
#include <vector>

namespace stromboli::test {

/// Seconds within which a program does what it does at once, on a machine however busy.
inline constexpr double kSoon = 250;

/// What standard error is: a terminal of so many columns, or a file (0).
struct Terminal {
    unsigned short columns = 0;
    std::string kind = "xterm"; ///< TERM
};

/// The program while it runs. Signals do to it what they do by default, whatever they do to the
/// test, unless they are to be ignored. `environment`: "A=1".
class RunningProgram {
  public:
    explicit RunningProgram(const std::vector<std::string>& arguments,
                            const Terminal& terminal = {},
                            const std::vector<std::string>& environment = {},
                            const std::vector<int>& ignored = {});
    /// Kills it if it still runs.
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    void send(int signal) const;
    bool hasEnded();
    /// Takes in what it says until standard error holds `text`; false if that takes longer than so
    /// many seconds.
    bool says(const std::string& text, double seconds);
    /// Waits for its end, but no longer than so many seconds: then its exit code is -1.
    ProgramRun finish(double seconds);

  private:
    void takeIn();

    ScratchFolder folder_;
    pid_t process_ = -1;
    int terminal_ = -1, status_ = 0;
    std::string shown_;
};

} // namespace stromboli::test
