#include "host/cli/status_line.hpp"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace stromboli::status_line {
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
