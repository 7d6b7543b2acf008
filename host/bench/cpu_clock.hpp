#pragma once

namespace stromboli::bench {

/// CPU time, user and system, of all threads of the process and of the processes that it started
/// and waited for, since the clock was made.
class CpuClock {
  public:
    CpuClock();
    double seconds() const;

  private:
    double start_;
};

} // namespace stromboli::bench
