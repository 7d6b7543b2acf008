#include "host/bench/report_json.hpp"
#include "host/bench/report_table.hpp"
#include "host/bench/startup_bench.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/command_line.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/signals.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/core/output.hpp"
#include "host/core/status_line.hpp"
#include "scene/find_scene.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

namespace stromboli {
namespace {

void writeJson(const std::string& file, const bench::BenchReport& report) {
    writeOutput(file, bench::toJson(report).dump(2) + "\n");
}

} // namespace

int benchCommand(const Options& options) {
    bench::BenchSettings settings = options.bench.settings;
    // llvmpipe asks for it when the device is opened: all contestants get as many threads.
    if (options.threads > 0) setenv("LP_NUM_THREADS", std::to_string(options.threads).c_str(), 1);
    if (options.bench.probeStartup) {
        fmt::print("{}", bench::toText(bench::probeStartup(sceneFile(settings.scenes.front()),
                                                           settings.device)));
        return 0;
    }
    if (!options.bench.jsonFile.empty()) checkOutputWritable(options.bench.jsonFile);
    settings.program = std::filesystem::read_symlink("/proc/self/exe").string();
    settings.commandLine = commandLine();
    onSignal(OnSignal::Ask);
    try {
        const bench::BenchReport report = bench::runBench(settings, [&](const std::string& step) {
            if (interrupted()) throw bench::Stopped();
            nowDoing("measuring", StatusLine::OfOthers);
            status_line::draw(step);
        });
        status_line::clear();
        if (!isStandardOutput(options.bench.jsonFile)) fmt::print("{}", bench::toTable(report));
        if (!options.bench.jsonFile.empty()) writeJson(options.bench.jsonFile, report);
    } catch (const bench::Stopped&) {
        logging::warn("interrupted: nothing is reported");
        return interruptedExitCode();
    }
    return 0;
}

} // namespace stromboli
