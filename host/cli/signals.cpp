#include "host/cli/signals.hpp"

#include "host/cli/progress.hpp"
#include "host/core/files.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <poll.h>
#include <string>
#include <thread>
#include <unistd.h>

namespace stromboli {
namespace {

std::atomic<OnSignal> response = OnSignal::End;
std::atomic<int> signalSeen = 0;
std::atomic<bool> noticed = false;

constexpr double kTickSeconds = 0.25; ///< of the status line

const char* nameOfSignal(int number) {
    switch (number) {
    case SIGINT:
        return "Ctrl-C (SIGINT)";
    case SIGTERM:
        return "SIGTERM";
    default:
        return "SIGHUP";
    }
}

/// Those of the three that the program's parent does not want ignored.
sigset_t watched() {
    sigset_t set;
    sigemptyset(&set);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action = {};
        if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
            sigaddset(&set, number);
    }
    return set;
}

/// A line that gets through whatever the other threads hold; not at all where nobody reads it.
void say(const std::string& line) {
    pollfd error = {STDERR_FILENO, POLLOUT, 0};
    if (poll(&error, 1, 0) != 1 || !(error.revents & POLLOUT)) return;
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
}

/// Nothing is destroyed and no stream is flushed: other threads are in the midst of anything.
[[noreturn]] void end(int number) {
    removeTemporaryFilesForGood();
    const std::string doing = whatIsBeingDone();
    say(fmt::format("{}error: ended by {}{}{}\n", status_line::isShown() ? status_line::kErase : "",
                    nameOfSignal(number), doing.empty() ? "" : " while ", doing));
    ::_exit(128 + number);
}

/// The next signal of the set; 0 if none comes in time. 0 seconds: for ever.
int nextSignal(const sigset_t& set, double seconds) {
    const timespec time = {time_t(seconds), long((seconds - double(time_t(seconds))) * 1e9)};
    for (;;) {
        const int number =
            seconds > 0 ? sigtimedwait(&set, nullptr, &time) : sigwaitinfo(&set, nullptr);
        if (number > 0) return number;
        if (errno == EAGAIN) return 0;
    }
}

void watch(const sigset_t set) {
    const double tick = status_line::isShown() ? kTickSeconds : 0;
    int number = 0;
    while ((number = nextSignal(set, tick)) == 0)
        redrawActivity();
    const OnSignal then = response;
    if (then == OnSignal::End) end(number);
    signalSeen = number;
    if (then == OnSignal::Ask)
        if (const int second = nextSignal(set, kPatienceSeconds); second != 0 || !noticed)
            end(number);
    nextSignal(set, 0);
    end(number);
}

} // namespace

void watchSignals() {
    std::signal(SIGPIPE, SIG_IGN);
    const sigset_t set = watched();
    pthread_sigmask(SIG_BLOCK, &set, nullptr);
    std::thread(watch, set).detach();
}

void onSignal(OnSignal next) {
    response = next;
}

bool interrupted() {
    if (signalSeen == 0) return false;
    noticed = true;
    return true;
}

int interruptedExitCode() {
    return 128 + signalSeen;
}

} // namespace stromboli
