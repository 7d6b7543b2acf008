#include "host/cli/progress.hpp"

#include "host/cli/status_line.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace stromboli {
namespace {

constexpr double kRedrawSeconds = 0.25;
constexpr int kBarWidth = 24; // characters
/// Some twenty dispatches: their length settles, and single ones no longer matter.
constexpr double kLeastToTellFromSeconds = 2;

} // namespace

std::optional<double> TimeLeft::after(double seconds, double done) {
    if (!firstSeconds_) {
        firstSeconds_ = seconds;
        firstShare_ = done;
    }
    const double took = seconds - *firstSeconds_, came = done - firstShare_;
    if (took < kLeastToTellFromSeconds || came <= 0) return std::nullopt;
    return took * (1 - done) / came;
}

ProgressBar::~ProgressBar() {
    status_line::clear();
}

/// What matters most comes first: a narrow terminal shows the beginning.
void ProgressBar::show(const RenderProgress& p) {
    const double now = watch_.seconds(), done = std::clamp(p.share, 0.0, 1.0);
    const std::optional<double> left = left_.after(now, done);
    if (!status_line::isShown() || (lastShown_ && now - *lastShown_ < kRedrawSeconds)) return;
    lastShown_ = now;
    const int filled = int(done * kBarWidth);
    status_line::draw(fmt::format(
        "{:5.1f} %  {} left  [{:#<{}}{:.<{}}] {:.2f} M samples  {:.2f} Mrays/s", 100 * done,
        left ? formatDuration(*left) : "?", "", filled, "", kBarWidth - filled,
        double(p.samplesDone) * 1e-6, double(p.counters.rays) * 1e-6 / std::max(now, 1e-3)));
}

std::string formatDuration(double seconds) {
    if (seconds < 1) return fmt::format("{:.0f} ms", seconds * 1e3);
    if (seconds < 100) return fmt::format("{:.1f} s", seconds);
    const auto whole = int64_t(seconds + 0.5);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

} // namespace stromboli
