#pragma once

#include "host/core/json.hpp"
#include "host/stress/case.hpp"

#include <string>
#include <vector>

namespace stromboli::stress {

/// What became of a case.
struct Outcome {
    Case which;
    Finding finding;
    std::string error; ///< why there is no finding; empty: there is one

    bool passed() const { return error.empty() && finding.passed(); }
};

/// Lines of a table, as wide as a terminal but for the property, which comes last.
std::string tableHead();
std::string tableRow(const Outcome& outcome);
/// For --list.
std::string listRow(const Case& which);

/// What a file of results says of the circumstances.
struct Circumstances {
    std::string device, driver, version;
    Amount amount = Amount::Full;
};

/// A number that is not finite becomes null.
Json toJson(const Circumstances& circumstances, const std::vector<Outcome>& outcomes);

} // namespace stromboli::stress
