#include "scene/build/report.hpp"

#include <fmt/format.h>

namespace stromboli::build {

void Report::Counts::add(const std::string& key, size_t count) {
    const auto [found, isNew] = index_.try_emplace(key, lines_.size());
    if (isNew) lines_.emplace_back(key, 0);
    lines_[found->second].second += count;
}

void Report::ignore(const std::string& what, const std::string& why, size_t count) {
    if (count > 0) ignored_.add(what + ": " + why, count);
}

void Report::warn(const std::string& what) {
    warnings_.add(what, 1);
}

void Report::writeTo(LoadReport& report) const {
    for (const auto& [line, count] : ignored_.lines())
        report.ignored.push_back(fmt::format("{} {}", count, line));
    for (const auto& [line, count] : warnings_.lines())
        report.warnings.push_back(count == 1 ? line : fmt::format("{} ({} times)", line, count));
}

} // namespace stromboli::build
