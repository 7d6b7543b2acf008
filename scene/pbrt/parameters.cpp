#include "scene/pbrt/parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {

build::FilePlace Parameters::placeOf(const Parameter& parameter) const {
    build::FilePlace where = place_;
    where.line = parameter.line;
    return where;
}

void Parameters::append(const std::vector<Parameter>& more) {
    list_.insert(list_.end(), more.begin(), more.end());
}

void Parameters::prepend(const std::vector<Parameter>& more) {
    list_.insert(list_.begin(), more.begin(), more.end());
}

std::vector<Parameter> Parameters::unread() const {
    std::vector<Parameter> rest;
    for (const Parameter& parameter : list_)
        if (!parameter.isRead) rest.push_back(parameter);
    return rest;
}

const Parameter* Parameters::find(std::string_view name) const {
    const Parameter* found = nullptr;
    for (const Parameter& parameter : list_) {
        if (parameter.name != name) continue;
        parameter.isRead = true;
        if (!found) found = &parameter;
    }
    return found;
}

bool Parameters::has(std::string_view name) const {
    return std::ranges::find(list_, name, &Parameter::name) != list_.end();
}

const Parameter* Parameters::numeric(std::string_view name, std::string_view expected) const {
    const Parameter* found = find(name);
    if (!found || !found->numbers.empty()) return found;
    replaceParameter(name, build::Shortfall::Word,
                     fmt::format("has no number, expected {}", expected));
    return nullptr;
}

std::optional<double> Parameters::number(std::string_view name) const {
    const Parameter* found = numeric(name, "one");
    if (!found) return std::nullopt;
    if (std::isfinite(found->numbers.front())) return found->numbers.front();
    replaceParameter(name, build::Shortfall::Word, "is no finite number");
    return std::nullopt;
}

double Parameters::number(std::string_view name, double otherwise, double least,
                          double most) const {
    const double value = number(name).value_or(otherwise);
    if (value < least || value > most)
        replaceParameter(name, build::Shortfall::Number,
                         fmt::format("is {}, expected {} to {}", value, least, most));
    return std::clamp(value, least, most);
}

std::optional<int64_t> Parameters::integer(std::string_view name) const {
    const std::optional<double> value = number(name);
    if (!value) return std::nullopt;
    constexpr double kMost = 1e15;
    return int64_t(std::clamp(*value, -kMost, kMost));
}

bool Parameters::flag(std::string_view name, bool otherwise) const {
    const Parameter* found = find(name);
    if (!found) return otherwise;
    if (!found->words.empty() &&
        (found->words.front() == "true" || found->words.front() == "false"))
        return found->words.front() == "true";
    replaceParameter(name, build::Shortfall::Word, "is no flag, expected true or false");
    return otherwise;
}

std::optional<std::string> Parameters::text(std::string_view name) const {
    const Parameter* found = find(name);
    if (!found) return std::nullopt;
    if (!found->words.empty()) return found->words.front();
    replaceParameter(name, build::Shortfall::Word, "has no string, expected one");
    return std::nullopt;
}

std::vector<double> Parameters::numbers(std::string_view name) const {
    const Parameter* found = numeric(name, "some");
    return found ? found->numbers : std::vector<double>();
}

std::vector<glm::dvec3> Parameters::points(std::string_view name) const {
    const Parameter* found = numeric(name, "three for each point");
    std::vector<glm::dvec3> points;
    if (!found) return points;
    const std::vector<double>& n = found->numbers;
    if (n.size() % 3 != 0)
        replaceParameter(name, build::Shortfall::Attribute,
                         fmt::format("has {} numbers, expected three for each point", n.size()));
    points.reserve(n.size() / 3);
    for (size_t i = 0; i + 2 < n.size(); i += 3)
        points.emplace_back(n[i], n[i + 1], n[i + 2]);
    return points;
}

std::optional<glm::dvec3> Parameters::vector(std::string_view name) const {
    const std::vector<glm::dvec3> all = points(name);
    return all.empty() ? std::nullopt : std::optional(all.front());
}

std::optional<std::string> Parameters::texture(std::string_view name) const {
    for (const Parameter& parameter : list_) {
        if (parameter.name != name) continue;
        if (parameter.type != "texture" || parameter.words.empty()) return std::nullopt;
        find(name);
        return parameter.words.front();
    }
    return std::nullopt;
}

void Parameters::skip(std::initializer_list<std::string_view> names) const {
    for (const std::string_view name : names)
        find(name);
}

void Parameters::reportUnread() const {
    for (const Parameter& parameter : list_)
        if (!parameter.isRead)
            report_->replace(placeOf(parameter), build::Shortfall::Parameter,
                             fmt::format("has '{}', which nothing reads", parameter.name));
}

void Parameters::replace(build::Shortfall kind, const std::string& problem) const {
    report_->replace(place_, kind, problem);
}

void Parameters::replace(build::Shortfall kind, const std::string& problem,
                         const std::string& instead) const {
    report_->replace(place_, kind, problem, instead);
}

void Parameters::replaceParameter(std::string_view name, build::Shortfall kind,
                                  const std::string& problem) const {
    const auto found = std::ranges::find(list_, name, &Parameter::name);
    report_->replace(found == list_.end() ? place_ : placeOf(*found), kind,
                     fmt::format("'{}' {}", name, problem));
}

} // namespace stromboli::pbrt
