#pragma once

#include "host/core/json.hpp"
#include "host/regress/judge.hpp"

#include <filesystem>
#include <string>

namespace stromboli::regress {

/// A line for each picture and each reason, and the verdict of the suite.
std::string toText(const Results& results);
Json toJson(const Results& results);
/// A <testsuite> as JUnit writes it and continuous integration reads it: a picture is a test case,
/// one that differs a failure, one that could not be made an error, one that is undecided or was
/// not run is skipped.
std::string toJunit(const Results& results);
/// A page without anything to fetch: pictures that flicker between golden and new, differences,
/// figures. folder: of the pictures that the outcomes name.
std::string toPage(const Results& results, const std::filesystem::path& folder);

} // namespace stromboli::regress
