#include "scene/build/report.hpp"

#include <fmt/format.h>

namespace stromboli::build {

static std::string counted(const std::string& line, size_t count) {
    return count == 1 ? line : fmt::format("{} ({} times)", line, count);
}

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

/// Once, however often what is strict is asked.
static std::string asStrict(const std::string& problem) {
    constexpr std::string_view kReason = " (an error because of --strict)";
    return problem.ends_with(kReason) ? problem : problem + std::string(kReason);
}

void Report::forgive(const FilePlace& where, const std::string& problem,
                     const std::string& reading) {
    if (strict_) where.fail(asStrict(problem));
    firstForgiven_.try_emplace(reading, where.describe(problem + ": " + reading));
    forgiven_.add(reading, 1);
}

void Report::replace(const FilePlace& where, Shortfall kind, const std::string& problem) {
    forgive(where, problem, std::string(insteadOf(kind)));
}

void Report::replace(const FilePlace& where, Shortfall kind, const std::string& problem,
                     const std::string& instead) {
    forgive(where, problem, fmt::format("{}: {}", insteadOf(kind), instead));
}

void Report::replace(const Error& error, Shortfall kind) {
    const std::string reading(insteadOf(kind));
    if (strict_) throw SceneError(asStrict(error.what()));
    if (!firstError_) firstError_ = error.what();
    firstForgiven_.try_emplace(reading, fmt::format("{}: {}", error.what(), reading));
    forgiven_.add(reading, 1);
}

void Report::adopt(const LoadReport& other,
                   const std::function<bool(const std::string&)>& isLeftOut) {
    for (const std::string& line : other.warnings)
        if (!isLeftOut(line)) warn(line);
    for (const std::string& line : other.forgiven) {
        if (isLeftOut(line)) continue;
        if (strict_) throw SceneError(asStrict(line));
        firstForgiven_.try_emplace(line, line);
        forgiven_.add(line, 1);
    }
}

void Report::assume(const std::string& what) {
    assumed_.add(what, 1);
}

void Report::writeTo(LoadReport& report) const {
    for (const auto& [line, count] : ignored_.lines())
        report.ignored.push_back(fmt::format("{} {}", count, line));
    for (const auto& [line, count] : warnings_.lines())
        report.warnings.push_back(counted(line, count));
    for (const auto& [reading, count] : forgiven_.lines())
        report.forgiven.push_back(counted(firstForgiven_.at(reading), count));
    for (const auto& [line, count] : assumed_.lines())
        report.assumed.push_back(counted(line, count));
}

} // namespace stromboli::build
