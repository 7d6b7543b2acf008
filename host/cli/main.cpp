#include "host/cli/commands.hpp"
#include "host/cli/options.hpp"
#include "host/core/error.hpp"
#include "host/core/log.hpp"
#include "host/vulkan/vector_width.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <exception>
#include <new>
#include <thread>

namespace {

int run(const stromboli::Options& options) {
    using stromboli::Command;
    const tbb::global_control threads(
        tbb::global_control::max_allowed_parallelism,
        options.threads ? options.threads : std::max(1u, std::thread::hardware_concurrency()));
    switch (options.command) {
    case Command::Render:
        return options.sampleAlone ? stromboli::sampleCommand(options)
                                   : stromboli::renderCommand(options);
    case Command::Check:
        return stromboli::checkCommand(options);
    case Command::Info:
        return stromboli::infoCommand(options);
    case Command::Devices:
        return stromboli::devicesCommand(options);
    case Command::Bench:
        return stromboli::benchCommand(options);
    case Command::Compare:
        return stromboli::compareCommand(options);
    case Command::Study:
        return stromboli::studyCommand(options);
    case Command::Stress:
        return stromboli::stressCommand(options);
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    stromboli::setUpLogging(stromboli::Verbosity::Normal);
    stromboli::vulkan::useWideVectors();
    try {
        const auto options = stromboli::parseOptions({argv + 1, argv + argc});
        if (!options) return 0;
        stromboli::setUpLogging(options->verbosity);
        return run(*options);
    } catch (const stromboli::Error& error) {
        spdlog::error("{}", error.what());
        return int(error.code());
    } catch (const std::bad_alloc&) {
        spdlog::error("out of memory");
        return int(stromboli::ExitCode::Scene);
    } catch (const std::exception& error) {
        spdlog::error("{}", error.what());
        return int(stromboli::ExitCode::Device);
    }
}
