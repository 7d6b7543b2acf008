#include "host/cli/progress.hpp"

#include "host/cli/log.hpp"
#include "host/core/json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <sys/ioctl.h>
#include <unistd.h>

namespace stromboli::status_line {

// --- The status line -----------------------------------------------------------------------------

namespace {

std::atomic<bool> wantedByUser = false;

struct State {
    std::mutex mutex;
    bool isDrawn = false;
};

/// Never destroyed: threads may still draw when main has returned.
State& state() {
    static State& line = *new State;
    return line;
}

bool terminalCanRedraw() {
    static const bool can = [] {
        const char* const kind = std::getenv("TERM");
        return isatty(STDERR_FILENO) != 0 && kind && std::string_view(kind) != "dumb";
    }();
    return can;
}

/// The terminal may be resized at any time.
size_t columns() {
    winsize size = {};
    constexpr size_t kUsual = 80;
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsual;
}

/// The first `most` characters of UTF-8 text: a byte 10xxxxxx goes on with a character.
std::string_view firstCharacters(std::string_view text, size_t most) {
    size_t characters = 0;
    for (size_t i = 0; i < text.size(); ++i)
        if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80 && characters++ == most)
            return text.substr(0, i);
    return text;
}

void print(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

} // namespace

void allow(bool wanted) {
    wantedByUser = wanted;
}

bool isShown() {
    return wantedByUser && terminalCanRedraw();
}

void draw(std::string_view text) {
    if (!isShown()) return;
    const std::lock_guard lock(state().mutex);
    state().isDrawn = true;
    // In the last column some terminals would begin a new line.
    print(std::string(kErase) + std::string(firstCharacters(text, columns() - 1)));
}

void clear() {
    if (!terminalCanRedraw()) return;
    const std::lock_guard lock(state().mutex);
    if (!state().isDrawn) return;
    state().isDrawn = false;
    print(kErase);
}

} // namespace stromboli::status_line

namespace stromboli {

// --- Activity ------------------------------------------------------------------------------------

namespace {

/// What takes less is done before anyone could have read its name.
constexpr double kWorthNamingSeconds = 0.5;

struct State {
    std::mutex mutex; // held while the line is drawn, so that no old text is drawn over a new one
    std::string what;
    StatusLine line = StatusLine::OfOthers;
    Stopwatch since;
    bool isDrawn = false;
};

/// Never destroyed: the thread that watches for signals outlives main.
State& state() {
    static State& activity = *new State;
    return activity;
}

} // namespace

void nowDoing(const std::string& what, StatusLine line) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.isDrawn) status_line::clear();
    s.isDrawn = false;
    s.what = what;
    s.line = line;
    s.since = {};
}

std::string whatIsBeingDone() {
    const std::unique_lock lock(state().mutex, std::try_to_lock);
    return lock ? state().what : std::string();
}

void redrawActivity() {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.line == StatusLine::OfOthers || s.since.seconds() < kWorthNamingSeconds) return;
    s.isDrawn = true;
    status_line::draw(fmt::format("{}, {:.0f} s", s.what, s.since.seconds()));
}

Listener toTerminal() {
    Listener listener;
    listener.message = [](Severity severity, const std::string& text) {
        switch (severity) {
        case Severity::Detail:
            return logging::debug(text);
        case Severity::Information:
            return logging::info(text);
        case Severity::Warning:
            return logging::warn(text);
        case Severity::Error:
            return logging::error(text);
        }
    };
    listener.activity = [](Stage stage, const std::string& what) {
        nowDoing(what, stage == Stage::Sampling ? StatusLine::OfOthers : StatusLine::OfActivity);
    };
    return listener;
}

// --- Progress ------------------------------------------------------------------------------------

namespace {

constexpr double kRedrawSeconds = 0.25;
constexpr int kBarWidth = 24; // characters
/// Some twenty dispatches: their length settles, and single ones no longer matter.
constexpr double kLeastToTellFromSeconds = 2;

/// As a whole, whatever other threads write, and where the status line was.
void printLine(std::string line) {
    status_line::clear();
    line += '\n';
    std::fwrite(line.data(), 1, line.size(), stderr);
    std::fflush(stderr);
}

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
    if (request_.form == ProgressForm::Objects && notShown_)
        printLine(progressAsJson(*notShown_, watch_.seconds(), std::nullopt));
}

std::string progressInWords(const RenderProgress& p, double seconds, std::optional<double> left) {
    return fmt::format("{:.1f} %, {:.2f} M samples in {}, {} left",
                       100 * std::clamp(p.share, 0.0, 1.0), double(p.samplesDone) * 1e-6,
                       formatDuration(seconds), left ? formatDuration(*left) : "?");
}

std::string progressAsJson(const RenderProgress& p, double seconds, std::optional<double> left) {
    const Json object = {{"share", std::clamp(p.share, 0.0, 1.0)},
                         {"samples", p.samplesDone},
                         {"rays", p.counters.rays},
                         {"seconds", seconds},
                         {"secondsLeft", left ? Json(*left) : Json()}};
    return object.dump();
}

/// What matters most comes first: a narrow terminal shows the beginning.
void ProgressBar::show(const RenderProgress& p) {
    const double now = watch_.seconds(), done = std::clamp(p.share, 0.0, 1.0);
    const std::optional<double> left = left_.after(now, done);
    const bool isBar = request_.form == ProgressForm::Auto && status_line::isShown();
    if (request_.form == ProgressForm::Off) return;
    notShown_ = p;
    if (now - lastShown_ < (isBar ? kRedrawSeconds : request_.everySeconds)) return;
    lastShown_ = now;
    notShown_.reset();
    if (request_.form == ProgressForm::Objects) return printLine(progressAsJson(p, now, left));
    if (!isBar) return logging::info(progressInWords(p, now, left));
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
