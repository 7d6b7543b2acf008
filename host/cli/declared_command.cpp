#include "host/cli/declared_command.hpp"

#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace stromboli {

// --- Options -------------------------------------------------------------------------------------

std::string inWords(Range<uint32_t> range) {
    return fmt::format("{} to {}", range.least, range.most);
}

std::string inWords(Range<double> range) {
    return fmt::format("{} to {}", range.least, range.most);
}

namespace {

/// The value in the range; otherwise the error that names the option and the range.
template <class T, class Value>
T inRange(const std::string& option, const std::string& word, const std::optional<Value>& value,
          Range<T> range, const char* kind) {
    if (!value || !(*value >= range.least && *value <= range.most))
        refuse(option, word, fmt::format("{} from {}", kind, inWords(range)));
    return T(*value);
}

} // namespace

uint32_t readNumber(const std::string& option, const std::string& word, Range<uint32_t> range) {
    return inRange(option, word, wholeNumber(word), range, "a whole number");
}

std::optional<double> quantityIn(std::string_view word, Units units) {
    const auto endsWord = [&](const Unit& unit) { return word.ends_with(unit.name); };
    const std::optional<double> plain = realNumber(word);
    if (plain && std::ranges::none_of(units, endsWord)) return plain;
    constexpr std::string_view kOfNumbers = "0123456789.eE+-";
    double sum = 0, before = std::numeric_limits<double>::infinity();
    for (std::string_view rest = word; !rest.empty();) {
        const size_t digits = std::min(rest.find_first_not_of(kOfNumbers), rest.size());
        const size_t end = std::min(rest.find_first_of("0123456789.", digits), rest.size());
        const std::optional<double> number = realNumber(rest.substr(0, digits));
        const auto unit = std::ranges::find(units, rest.substr(digits, end - digits),
                                            [](const Unit& u) { return std::string_view(u.name); });
        if (!number || unit == units.end() || unit->factor >= before) return std::nullopt;
        if (*number < 0 && end < rest.size()) return std::nullopt; // of what would that be less?
        sum += *number * unit->factor;
        before = unit->factor;
        rest.remove_prefix(end);
    }
    return word.empty() ? std::nullopt : std::optional(sum);
}

double readReal(const std::string& option, const std::string& word, Range<double> range,
                Units units) {
    const std::optional<double> value = quantityIn(word, units);
    if (value && *value >= range.least && *value <= range.most) return *value;
    std::string expected = "a number from " + inWords(range);
    for (const Unit& unit : units)
        expected += fmt::format("{}{}", &unit == units.data() ? ", maybe with its unit: " : ", ",
                                unit.name);
    refuse(option, word, expected);
}

void refuse(const std::string& option, const std::string& word, const std::string& expected) {
    throw UsageError(fmt::format("{} is '{}': expected {}", option, word, expected));
}

void refuseName(const std::string& option, const std::string& word, const Words& names,
                const std::string& namesInWords) {
    refuse(option, word, namesInWords + didYouMean(word, names));
}

CommandOption& CommandOption::usually(std::string text) {
    usual = std::move(text);
    return *this;
}

CommandOption& CommandOption::from(std::string numbers) {
    range = std::move(numbers);
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

CommandOption& CommandOption::implies(std::string option) {
    implied.push_back(std::move(option));
    return *this;
}

CommandOption& CommandOption::required() {
    isRequired = true;
    return *this;
}

CommandOption&
CommandOption::changesDefaults(std::vector<std::pair<std::string, std::string>> words) {
    isFirst = true;
    changedDefaults = std::move(words);
    return *this;
}

CommandOption& CommandOption::besidePicture() {
    isBesidePicture = true;
    return *this;
}

CommandOption& CommandOption::hidden() {
    isHidden = true;
    return *this;
}

CommandOption& CommandOption::maybeJoined() {
    mayBeJoined = true;
    return *this;
}

CommandOption& CommandOption::maybeApart() {
    mayBeApart = true;
    return *this;
}

CommandOption& CommandOption::maybeWithout(std::string word,
                                           std::function<bool(const std::string&)> isItsWord) {
    ifMissing = std::move(word);
    isItsOwn = std::move(isItsWord);
    return *this;
}

CommandOption& CommandOption::common() {
    isCommon = true;
    return *this;
}

CommandOption& CommandOption::proposes(Words words) {
    proposals = std::move(words);
    return *this;
}

CommandOption& CommandOption::proposes(Proposed what) {
    proposed = what;
    return *this;
}

Words CommandOption::dashedNames() const {
    Words dashed;
    std::istringstream list(names);
    for (std::string name; std::getline(list, name, ',');)
        if (name.starts_with("-")) dashed.push_back(name);
    return dashed;
}

std::string CommandOption::fullHelp() const {
    return help + (range.empty() ? "" : "; " + range) +
           (usual.empty() ? "" : fmt::format(" [{}]", usual));
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

CommandOption& OptionList::onOff(std::string names, std::string help, bool& where) {
    CommandOption& o = words(std::move(names), "WHETHER", std::move(help), 1, {});
    o.usual = where ? "on" : "off";
    o.proposals = {"on", "off"};
    o.store = [&where, name = o.name()](const Words& given) {
        if (given.front() != "on" && given.front() != "off")
            refuse(name, given.front(), "on or off");
        where = given.front() == "on";
    };
    return o;
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
    o.from(inWords(range)).store = [&where, range, name = o.name()](const Words& given) {
        where = readNumber(name, given.front(), range);
    };
    return o;
}

CommandOption& OptionList::numbers(std::string names, std::string valueNames, std::string help,
                                   std::vector<uint32_t*> where, Range<uint32_t> range) {
    CommandOption& o =
        words(std::move(names), std::move(valueNames), std::move(help), uint32_t(where.size()), {});
    o.from(inWords(range)).store = [where = std::move(where), range,
                                    name = o.name()](const Words& given) {
        for (size_t i = 0; i < where.size(); ++i)
            *where[i] = readNumber(name, given[i], range);
    };
    return o;
}

CommandOption& OptionList::real(std::string names, std::string valueName, std::string help,
                                double& where, Range<double> range, Units units) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.usual = fmt::format("{}", where);
    o.from(inWords(range)).store = [&where, range, units, name = o.name()](const Words& given) {
        where = readReal(name, given.front(), range, units);
    };
    return o;
}

CommandOption& OptionList::real(std::string names, std::string valueName, std::string help,
                                std::optional<double>& where, Range<double> range, Units units) {
    CommandOption& o = words(std::move(names), std::move(valueName), std::move(help), 1, {});
    o.from(inWords(range)).store = [&where, range, units, name = o.name()](const Words& given) {
        where = readReal(name, given.front(), range, units);
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

void OptionList::makeCommon(const Words& names) {
    for (const std::string& name : names) {
        const auto named = std::ranges::find_if(options_, [&](const CommandOption& o) {
            const Words dashed = o.dashedNames();
            return std::ranges::count(dashed, name) > 0;
        });
        if (named == options_.end()) throw std::logic_error("no option is called " + name);
        named->common();
    }
}

void OptionList::sayChangedDefaults() {
    for (const CommandOption& changing : options_)
        for (const auto& [name, word] : changing.changedDefaults)
            for (CommandOption& o : options_)
                if (o.name() == name) o.usual += fmt::format("; {}: {}", changing.name(), word);
}

} // namespace stromboli
