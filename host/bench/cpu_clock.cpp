#include "host/bench/cpu_clock.hpp"

#include <sys/resource.h>

namespace stromboli::bench {
namespace {

double secondsOf(int who) {
    rusage usage{};
    getrusage(who, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double now() {
    return secondsOf(RUSAGE_SELF) + secondsOf(RUSAGE_CHILDREN);
}

} // namespace

CpuClock::CpuClock() : start_(now()) {}

double CpuClock::seconds() const {
    return now() - start_;
}

} // namespace stromboli::bench
