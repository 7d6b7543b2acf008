#include "host/cli/progress.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

namespace stromboli {
namespace {

volatile std::sig_atomic_t interruptSeen = 0;

void onInterrupt(int number) {
    interruptSeen = 1;
    std::signal(number, SIG_DFL);
}

constexpr double kRedrawSeconds = 0.25;
constexpr int kBarWidth = 24; // characters

} // namespace

void watchForInterrupt() {
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
}

bool interrupted() {
    return interruptSeen != 0;
}

ProgressBar::ProgressBar(bool wanted) : shown_(wanted && isatty(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() {
    if (drawn_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::show(const RenderProgress& p) {
    const double now = watch_.seconds();
    if (!shown_ || (lastShown_ >= 0 && now - lastShown_ < kRedrawSeconds)) return;
    lastShown_ = now;
    drawn_ = true;
    const double done = std::clamp(p.share, 0.0, 1.0);
    const int filled = int(done * kBarWidth);
    const double left = done > 0 ? now * (1 - done) / done : 0;
    fmt::print(stderr,
               "\r\033[K[{:#<{}}{:.<{}}] {:5.1f} %  {:.2f} M samples  {:.2f} Mrays/s  {} left", "",
               filled, "", kBarWidth - filled, 100 * done, double(p.samplesDone) * 1e-6,
               double(p.counters.rays) * 1e-6 / std::max(now, 1e-3),
               done > 0 ? formatDuration(left) : "?");
    std::fflush(stderr);
}

std::string formatDuration(double seconds) {
    if (seconds < 1) return fmt::format("{:.0f} ms", seconds * 1e3);
    if (seconds < 100) return fmt::format("{:.1f} s", seconds);
    const auto whole = int64_t(seconds + 0.5);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

} // namespace stromboli
