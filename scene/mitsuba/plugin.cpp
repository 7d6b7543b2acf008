#include "scene/mitsuba/plugin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace stromboli::mitsuba {

std::string typeOf(const Value& value) {
    static constexpr std::array kTypes = {"a boolean",  "an integer", "a float",
                                          "a string",   "a vector",   "an rgb colour",
                                          "a spectrum", "a transform"};
    static_assert(kTypes.size() == std::variant_size_v<Value>);
    return kTypes.at(value.index());
}

void Plugin::add(const std::string& name, Value value, const build::FilePlace& where) {
    if (!parameters_.emplace(name, Parameter{std::move(value), where}).second)
        where.fail(fmt::format("'{}' is set already in this {}", name, tag));
    order_.push_back(name);
}

void Plugin::add(Child child) {
    const bool isThere = parameters_.contains(child.name);
    if (isThere) child.place.fail(fmt::format("'{}' is set already in this {}", child.name, tag));
    for (const Child& other : children_)
        if (!child.name.empty() && other.name == child.name)
            child.place.fail(fmt::format("'{}' is set already in this {}", child.name, tag));
    children_.push_back(std::move(child));
}

build::FilePlace Plugin::placeOf(std::string_view parameter) const {
    const auto found = parameters_.find(parameter);
    return found == parameters_.end() ? place : found->second.place;
}

void Plugin::fail(std::string_view parameter, const std::string& message) const {
    placeOf(parameter).fail(fmt::format("'{}' {}", parameter, message));
}

void Plugin::replace(build::Shortfall kind, const std::string& message) const {
    report->replace(place, kind, message);
}

void Plugin::replace(build::Shortfall kind, const std::string& message,
                     const std::string& instead) const {
    report->replace(place, kind, message, instead);
}

void Plugin::replaceParameter(std::string_view parameter, build::Shortfall kind,
                              const std::string& message) const {
    report->replace(placeOf(parameter), kind, fmt::format("'{}' {}", parameter, message));
}

const Plugin::Parameter* Plugin::ask(std::string_view name) const {
    asked_.insert(std::string(name));
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? nullptr : &found->second;
}

template <class T>
const T* Plugin::askFor(std::string_view name, const char* expected) const {
    const Parameter* found = ask(name);
    if (!found) {
        if (child(name))
            replaceParameter(name, build::Shortfall::Word,
                             fmt::format("is an object, expected {}", expected));
        return nullptr;
    }
    const T* value = std::get_if<T>(&found->value);
    if (!value)
        replaceParameter(name, build::Shortfall::Word,
                         fmt::format("is {}, expected {}", typeOf(found->value), expected));
    return value;
}

bool Plugin::has(std::string_view name) const {
    return ask(name) != nullptr;
}

const Value* Plugin::find(std::string_view name) const {
    const Parameter* found = ask(name);
    return found ? &found->value : nullptr;
}

std::optional<bool> Plugin::flag(std::string_view name) const {
    const bool* value = askFor<bool>(name, "a boolean");
    return value ? std::optional(*value) : std::nullopt;
}

std::optional<std::string> Plugin::text(std::string_view name) const {
    const std::string* value = askFor<std::string>(name, "a string");
    return value ? std::optional(*value) : std::nullopt;
}

std::optional<glm::dvec3> Plugin::vector(std::string_view name) const {
    const glm::dvec3* value = askFor<glm::dvec3>(name, "a point or vector");
    return value ? std::optional(*value) : std::nullopt;
}

std::optional<int64_t> Plugin::integer(std::string_view name) const {
    const Parameter* found = ask(name);
    const double* real = found ? std::get_if<double>(&found->value) : nullptr;
    constexpr double kMost = 0x1p53; // up to which doubles hold all whole numbers
    if (real && std::abs(*real) < kMost && std::trunc(*real) == *real) return int64_t(*real);
    const int64_t* value = askFor<int64_t>(name, "an integer");
    return value ? std::optional(*value) : std::nullopt;
}

std::optional<double> Plugin::number(std::string_view name, double least, double most) const {
    const Parameter* found = ask(name);
    const int64_t* whole = found ? std::get_if<int64_t>(&found->value) : nullptr;
    const double* real = whole ? nullptr : askFor<double>(name, "a float");
    if (!whole && !real) return std::nullopt;
    const double value = whole ? double(*whole) : *real;
    if (value >= least && value <= most) return value;
    const bool isOpen = most == std::numeric_limits<double>::max();
    replaceParameter(name, build::Shortfall::Number,
                     isOpen ? fmt::format("is {}, expected {} or more", value, least)
                            : fmt::format("is {}, expected {} to {}", value, least, most));
    return std::clamp(value, least, most);
}

glm::dmat4 Plugin::transform(std::string_view name) const {
    const glm::dmat4* value = askFor<glm::dmat4>(name, "a transform");
    return value ? *value : glm::dmat4(1.0);
}

std::string Plugin::requireText(std::string_view name) const {
    std::optional<std::string> value = text(name);
    if (!value || value->empty()) fail(fmt::format("has no string '{}'", name));
    return *std::move(value);
}

const Plugin* Plugin::child(std::string_view name) const {
    asked_.insert(std::string(name));
    for (const Child& c : children_)
        if (c.name == name) return c.plugin;
    return nullptr;
}

std::vector<const Plugin*> Plugin::childrenOf(std::string_view wanted) const {
    askedTags_.insert(std::string(wanted));
    std::vector<const Plugin*> found;
    for (const Child& c : children_)
        if (c.plugin->tag == wanted) found.push_back(c.plugin);
    return found;
}

const Plugin* Plugin::onlyChildOf(std::string_view wanted) const {
    const std::vector<const Plugin*> found = childrenOf(wanted);
    if (found.size() > 1)
        found[1]->replace(build::Shortfall::Node,
                          fmt::format("is the second {} of this {}, expected one", wanted, tag));
    return found.empty() ? nullptr : found.front();
}

bool Plugin::isRead(const Child& child) const {
    return askedTags_.contains(child.plugin->tag) ||
           (!child.name.empty() && asked_.contains(child.name));
}

std::vector<std::string> Plugin::unread() const {
    std::vector<std::string> names;
    for (const std::string& name : order_)
        if (!asked_.contains(name)) names.push_back(name);
    for (const Child& c : children_)
        if (!isRead(c)) names.push_back(c.name.empty() ? c.plugin->tag : c.name);
    return names;
}

void Plugin::requireAllRead() const {
    const std::vector<std::string> names = unread();
    if (names.empty()) return;
    std::string known;
    for (const std::string& name : asked_)
        known += (known.empty() ? "" : ", ") + name;
    for (const std::string& name : names)
        replaceParameter(name, build::Shortfall::Parameter,
                         fmt::format("is not read in {} '{}'{}{}", tag, type,
                                     known.empty() ? "" : "; expected one of ", known));
}

} // namespace stromboli::mitsuba
