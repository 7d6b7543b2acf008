#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli {

static std::string located(const std::string& file, int line, const std::string& element,
                           const std::string& message) {
    std::string where = line > 0 ? fmt::format("{}:{}: ", file, line) : fmt::format("{}: ", file);
    if (!element.empty()) where += fmt::format("<{}>: ", element);
    return where + message;
}

SceneError::SceneError(const std::string& file, int line, const std::string& element,
                       const std::string& message)
    : SceneError(located(file, line, element, message)) {}

} // namespace stromboli
