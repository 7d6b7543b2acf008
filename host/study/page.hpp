#pragma once

#include "host/study/study.hpp"

#include <filesystem>
#include <string>
#include <string_view>

namespace stromboli::study {

/// The report as one HTML page that needs nothing else: figures, script, and, from the study's
/// folder, the reference and a picture of each configuration, the one that took nearest the time
/// in which the baseline reaches the target error. Pictures that are not there are left out, and
/// scenes without a run, of which there has to be one.
std::string toPage(const Study& study, const std::filesystem::path& folder);

} // namespace stromboli::study
