#include "host/core/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>

namespace stromboli {

void setUpLogging(Verbosity verbosity) {
    auto logger = std::make_shared<spdlog::logger>(
        "stromboli", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    logger->set_pattern("%^%l:%$ %v");
    switch (verbosity) {
    case Verbosity::Quiet:
        logger->set_level(spdlog::level::warn);
        break;
    case Verbosity::Normal:
        logger->set_level(spdlog::level::info);
        break;
    case Verbosity::Verbose:
        logger->set_level(spdlog::level::debug);
        break;
    }
    spdlog::set_default_logger(logger);
}

} // namespace stromboli
