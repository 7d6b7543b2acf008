#include "host/bench/bench_scene.hpp"
#include "host/bench/report_json.hpp"
#include "host/bench/report_table.hpp"
#include "host/bench/startup_bench.hpp"
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/progress.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>

namespace stromboli {
namespace {

/// A line on standard error that says what is being measured: only on a terminal.
class StepLine {
  public:
    explicit StepLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO)) {}
    ~StepLine() {
        if (shown_) fmt::print(stderr, "\r\033[K");
    }
    StepLine(const StepLine&) = delete;
    StepLine& operator=(const StepLine&) = delete;

    void show(const std::string& step) const {
        if (!shown_) return;
        fmt::print(stderr, "\r\033[K{}", step);
        std::fflush(stderr);
    }

  private:
    bool shown_;
};

void writeJson(const std::string& file, const bench::BenchReport& report) {
    const std::string text = bench::toJson(report).dump(2) + "\n";
    writeFileAtomically(file, std::as_bytes(std::span(text)));
}

} // namespace

int benchCommand(const Options& options) {
    bench::BenchSettings settings = options.bench.settings;
    // llvmpipe asks for it when the device is opened: all contestants get as many threads.
    if (options.threads > 0) setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 1);
    if (options.bench.probeStartup) {
        fmt::print("{}", bench::toText(bench::probeStartup(
                             bench::benchSceneFile(settings.scenes.front()), settings.device)));
        return 0;
    }
    if (!options.bench.jsonFile.empty()) checkFileWritable(options.bench.jsonFile);
    settings.program = std::filesystem::read_symlink("/proc/self/exe").string();
    settings.commandLine = commandLine();
    watchForInterrupt();
    try {
        const bench::BenchReport report = [&] {
            const StepLine line(options.verbosity != Verbosity::Quiet);
            return bench::runBench(settings, [&](const std::string& step) {
                if (interrupted()) throw bench::Stopped();
                line.show(step);
            });
        }();
        fmt::print("{}", bench::toTable(report));
        if (!options.bench.jsonFile.empty()) writeJson(options.bench.jsonFile, report);
    } catch (const bench::Stopped&) {
        logging::warn("interrupted: nothing is reported");
        return kInterruptedExitCode;
    }
    return 0;
}

} // namespace stromboli
