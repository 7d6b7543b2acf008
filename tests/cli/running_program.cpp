#include "tests/cli/running_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>

namespace stromboli::test {
namespace {

std::string contentOf(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// Asks again and again; false if it was never true.
bool within(double seconds, const std::function<bool()>& isSo) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        if (isSo()) return true;
        usleep(2000);
    }
    return isSo();
}

[[noreturn]] void become(const std::vector<std::string>& arguments, const std::string& out,
                         int standardError, const Terminal& terminal,
                         const std::vector<std::string>& environment,
                         const std::vector<int>& ignored) {
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE})
        signal(number, SIG_DFL);
    for (const int number : ignored)
        signal(number, SIG_IGN);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    setenv("TERM", terminal.kind.c_str(), 1);
    for (const std::string& setting : environment)
        putenv(strdup(setting.c_str()));
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(standardError, STDERR_FILENO);
    std::vector<char*> words = {strdup(STROMBOLI_PROGRAM)};
    for (const std::string& argument : arguments)
        words.push_back(strdup(argument.c_str()));
    words.push_back(nullptr);
    execv(STROMBOLI_PROGRAM, words.data());
    _exit(127);
}

} // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const Terminal& terminal,
                               const std::vector<std::string>& environment,
                               const std::vector<int>& ignored) {
    int error = -1;
    if (terminal.columns > 0) {
        const winsize size = {24, terminal.columns, 0, 0};
        if (openpty(&terminal_, &error, nullptr, nullptr, &size) != 0)
            throw std::runtime_error("no terminal");
        fcntl(terminal_, F_SETFL, O_NONBLOCK);
    } else {
        error = open(folder_.file("err").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    }
    process_ = fork();
    if (process_ == 0)
        become(arguments, folder_.file("out"), error, terminal, environment, ignored);
    close(error);
}

RunningProgram::~RunningProgram() {
    if (process_ > 0 && !hasEnded()) {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    if (terminal_ >= 0) close(terminal_);
}

void RunningProgram::send(int number) const {
    kill(process_, number);
}

void RunningProgram::takeIn() {
    if (terminal_ < 0) {
        shown_ = contentOf(folder_.file("err"));
        return;
    }
    char bytes[4096];
    for (ssize_t n; (n = ::read(terminal_, bytes, sizeof bytes)) > 0;)
        shown_.append(bytes, size_t(n));
}

bool RunningProgram::hasEnded() {
    if (process_ > 0 && waitpid(process_, &status_, WNOHANG) == process_) process_ = 0;
    return process_ == 0;
}

bool RunningProgram::says(const std::string& text, double seconds) {
    return within(seconds, [&] {
        takeIn();
        return shown_.find(text) != std::string::npos;
    });
}

ProgramRun RunningProgram::finish(double seconds) {
    ProgramRun run;
    const bool ended = within(seconds, [&] {
        takeIn(); // or a full terminal would stop it
        return hasEnded();
    });
    takeIn();
    run.out = contentOf(folder_.file("out"));
    run.err = shown_;
    if (ended) run.exitCode = WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
    return run;
}

} // namespace stromboli::test
