#include "host/cli/log.hpp"

#include "host/core/printable.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

namespace stromboli {
namespace {

void (*beforeMessages)() = nullptr;

spdlog::level::level_enum levelOf(Verbosity verbosity) {
    switch (verbosity) {
    case Verbosity::ErrorsOnly:
        return spdlog::level::err;
    case Verbosity::Quiet:
        return spdlog::level::warn;
    case Verbosity::Verbose:
        return spdlog::level::debug;
    case Verbosity::Normal:
        break;
    }
    return spdlog::level::info;
}

} // namespace

void setUpLogging(Verbosity verbosity, void (*before)()) {
    beforeMessages = before;
    // https://no-color.org: colours are unwanted if the variable is set and not empty.
    const char* const plain = std::getenv("NO_COLOR");
    auto logger = std::make_shared<spdlog::logger>(
        "stromboli",
        std::make_shared<spdlog::sinks::stderr_color_sink_mt>(
            plain && *plain ? spdlog::color_mode::never : spdlog::color_mode::automatic));
    logger->set_pattern("%^%l:%$ %v");
    spdlog::set_default_logger(logger);
    setVerbosity(verbosity);
}

void setVerbosity(Verbosity verbosity) {
    spdlog::set_level(levelOf(verbosity));
}

static void log(spdlog::level::level_enum level, std::string_view message) {
    if (!spdlog::should_log(level)) return;
    if (beforeMessages) beforeMessages();
    spdlog::log(level, printable(message));
}

void logging::debug(std::string_view message) {
    log(spdlog::level::debug, message);
}

void logging::info(std::string_view message) {
    log(spdlog::level::info, message);
}

void logging::warn(std::string_view message) {
    log(spdlog::level::warn, message);
}

void logging::error(std::string_view message) {
    log(spdlog::level::err, message);
}

} // namespace stromboli
