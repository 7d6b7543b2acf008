#include "host/core/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace stromboli {
namespace {

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

void setUpLogging(Verbosity verbosity) {
    auto logger = std::make_shared<spdlog::logger>(
        "stromboli", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    logger->set_pattern("%^%l:%$ %v");
    spdlog::set_default_logger(logger);
    setVerbosity(verbosity);
}

void setVerbosity(Verbosity verbosity) {
    spdlog::set_level(levelOf(verbosity));
}

void logging::debug(std::string_view message) {
    spdlog::debug(message);
}

void logging::info(std::string_view message) {
    spdlog::info(message);
}

void logging::warn(std::string_view message) {
    spdlog::warn(message);
}

void logging::error(std::string_view message) {
    spdlog::error(message);
}

} // namespace stromboli
