#pragma once

#include "host/core/error.hpp"

#include <functional>
#include <string>

namespace stromboli::test {

/// The message of the UsageError that the action throws; empty if it throws none.
inline std::string refusalOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const UsageError& error) {
        return error.what();
    }
    return "";
}

} // namespace stromboli::test
