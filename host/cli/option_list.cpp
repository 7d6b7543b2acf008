#include "host/cli/option_list.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <charconv>

namespace stromboli {
namespace {

/// The whole word as a number; empty if it is none, or has more digits than the type holds.
template <class T>
std::optional<T> parsed(const std::string& word) {
    T value{};
    const char* const last = word.data() + word.size();
    const auto [end, error] = std::from_chars(word.data(), last, value);
    if (error != std::errc() || end != last) return std::nullopt;
    return value;
}

template <class T>
T readInRange(const std::string& option, const std::string& word, Range<T> range,
              const char* kind) {
    const std::optional<T> value = parsed<T>(word);
    if (!value || !(*value >= range.least && *value <= range.most)) // NaN fails both
        throw UsageError(fmt::format("{} is '{}': expected {} from {} to {}", option, word, kind,
                                     range.least, range.most));
    return *value;
}

} // namespace

uint32_t readNumber(const std::string& option, const std::string& word, Range<uint32_t> range) {
    return readInRange(option, word, range, "a whole number");
}

double readReal(const std::string& option, const std::string& word, Range<double> range) {
    return readInRange(option, word, range, "a number");
}

void refuse(const std::string& option, const std::string& word, const std::string& expected) {
    throw UsageError(fmt::format("{} is '{}': expected {}", option, word, expected));
}

CommandOption& CommandOption::usually(std::string text) {
    usual = std::move(text);
    return *this;
}

CommandOption& CommandOption::excludes(std::string option, std::string reason) {
    conflicts.push_back({std::move(option), std::move(reason)});
    return *this;
}

CommandOption& CommandOption::needs(std::string option) {
    needed.push_back(std::move(option));
    return *this;
}

CommandOption& CommandOption::required() {
    isRequired = true;
    return *this;
}

CommandOption& CommandOption::changesDefaults() {
    isFirst = true;
    return *this;
}

CommandOption& CommandOption::hidden() {
    isHidden = true;
    return *this;
}

std::string CommandOption::name() const {
    return names.substr(0, names.find(','));
}

CommandOption& OptionList::words(std::string names, std::string valueNames, std::string help,
                                 uint32_t count, std::function<void(const Words&)> store) {
    CommandOption& o = options_.emplace_back();
    o.names = std::move(names);
    o.valueNames = std::move(valueNames);
    o.help = std::move(help);
    o.group = group_;
    o.wordCount = count;
    o.store = std::move(store);
    return o;
}

CommandOption& OptionList::flag(std::string names, std::string help, std::function<void()> store) {
    return words(std::move(names), "", std::move(help), 0,
                 [store = std::move(store)](const Words&) { store(); });
}

CommandOption& OptionList::flag(std::string names, std::string help, bool& where) {
    return flag(std::move(names), std::move(help), [&where] { where = true; });
}

CommandOption& OptionList::text(std::string names, std::string valueName, std::string help,
                                std::string& where) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.usual = where;
    o.store = [&where, name = o.name()](const Words& given) {
        if (given.front().empty())
            throw UsageError(fmt::format("{} is empty: expected text", name));
        where = given.front();
    };
    return o;
}

CommandOption& OptionList::number(std::string names, std::string valueName, std::string help,
                                  uint32_t& where, Range<uint32_t> range) {
    CommandOption& o =
        numbers(std::move(names), std::move(valueName), std::move(help), {&where}, range);
    o.usual = fmt::format("{}", where);
    return o;
}

CommandOption& OptionList::number(std::string names, std::string valueName, std::string help,
                                  std::optional<uint32_t>& where, Range<uint32_t> range) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.store = [&where, range, name = o.name()](const Words& given) {
        where = readNumber(name, given.front(), range);
    };
    return o;
}

CommandOption& OptionList::numbers(std::string names, std::string valueNames, std::string help,
                                   std::vector<uint32_t*> where, Range<uint32_t> range) {
    CommandOption& o =
        words(std::move(names), std::move(valueNames), std::move(help), uint32_t(where.size()), {});
    o.store = [where = std::move(where), range, name = o.name()](const Words& given) {
        for (size_t i = 0; i < where.size(); ++i)
            *where[i] = readNumber(name, given[i], range);
    };
    return o;
}

CommandOption& OptionList::real(std::string names, std::string valueName, std::string help,
                                double& where, Range<double> range) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.usual = fmt::format("{}", where);
    o.store = [&where, range, name = o.name()](const Words& given) {
        where = readReal(name, given.front(), range);
    };
    return o;
}

CommandOption& OptionList::real(std::string names, std::string valueName, std::string help,
                                std::optional<double>& where, Range<double> range) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.store = [&where, range, name = o.name()](const Words& given) {
        where = readReal(name, given.front(), range);
    };
    return o;
}

CommandOption& OptionList::list(std::string names, std::string valueName, std::string help,
                                Words& where) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.anyNumber = true;
    o.store = [&where, name = o.name()](const Words& given) {
        for (const std::string& word : given)
            if (word.empty()) throw UsageError(fmt::format("{} is empty: expected text", name));
        where = given;
    };
    return o;
}

} // namespace stromboli
