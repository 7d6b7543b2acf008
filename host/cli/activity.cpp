#include "host/cli/activity.hpp"

#include "host/cli/status_line.hpp"
#include "host/core/log.hpp"
#include "host/core/system.hpp"

#include <fmt/format.h>

#include <mutex>

namespace stromboli {
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
        }
    };
    listener.activity = [](Stage stage, const std::string& what) {
        nowDoing(what, stage == Stage::Sampling ? StatusLine::OfOthers : StatusLine::OfActivity);
    };
    return listener;
}

} // namespace stromboli
