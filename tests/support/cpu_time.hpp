#pragma once

#include <sys/resource.h>

namespace stromboli::test {

/// Seconds of CPU time that this process has used, all of its threads, and the processes that it
/// has waited for. Unlike the clock on the wall, it is the same on a busy machine.
inline double cpuSeconds() {
    double sum = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage used = {};
        ::getrusage(who, &used);
        for (const timeval& time : {used.ru_utime, used.ru_stime})
            sum += double(time.tv_sec) + double(time.tv_usec) * 1e-6;
    }
    return sum;
}

} // namespace stromboli::test
