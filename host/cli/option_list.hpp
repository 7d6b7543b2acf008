#pragma once

#include "host/core/text.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

using Words = std::vector<std::string>;

template <class T>
struct Range {
    T least, most;
};

/// "1 to 1024".
std::string inWords(Range<uint32_t> range);
std::string inWords(Range<double> range);

/// A whole number in a range, written as host/core/text.hpp says. Throws UsageError that
/// names the option and the range.
uint32_t readNumber(const std::string& option, const std::string& word, Range<uint32_t> range);
/// A real number in a range, likewise; NaN and infinity are none.
double readReal(const std::string& option, const std::string& word, Range<double> range);

/// Throws the UsageError that `option` is `word` where one of `expected` was to be.
[[noreturn]] void refuse(const std::string& option, const std::string& word,
                         const std::string& expected);

/// The names in the table of an enumeration.
template <class E>
Words namesOf() {
    Words names;
    for (const NamedValue<E>& row : kNamedValues<E>)
        names.emplace_back(row.name);
    return names;
}

/// What completion in a shell proposes for the words of an option, beside its `proposals`.
enum class Proposed { Nothing, Files, Folders, Scenes };

/// One option of a command, and all there is to say about it: what it is called, which words it
/// takes, what it means, where that is stored, and what it does not go with.
class CommandOption {
  public:
    /// Another option that cannot be given too, and why (may be empty).
    struct Conflict {
        std::string option;
        std::string reason;
    };

    /// The default in words, for --help, where it is not a value that is stored from the start.
    CommandOption& usually(std::string text);
    /// Takes numbers from this range, as inWords() puts it.
    CommandOption& from(std::string numbers);
    CommandOption& excludes(std::string option, std::string reason = "");
    /// Cannot be given without the other.
    CommandOption& needs(std::string option);
    /// Says this flag too.
    CommandOption& implies(std::string option);
    CommandOption& required();
    /// Changes the defaults of other options: is stored before them, wherever it stands.
    CommandOption& changesDefaults();
    /// Has no effect on the picture: its notes leave it out.
    CommandOption& besidePicture();
    /// Is understood, but not listed by --help, the manual page and completion.
    CommandOption& hidden();
    /// Words that completion proposes. Others may be understood too.
    CommandOption& proposes(Words words);
    CommandOption& proposes(Proposed what);

    /// As messages call it: the first of its names.
    std::string name() const;
    /// {"-l", "--light-samples"}; none: by position.
    Words dashedNames() const;
    /// Its help with the range and the default.
    std::string fullHelp() const;

    std::string names;      ///< "-l,--light-samples"; without dashes: by position
    std::string valueNames; ///< of its words, as "W H"; empty: a flag
    std::string help, group, usual;
    std::string range; ///< of its numbers, in words; empty: it takes none
    uint32_t wordCount = 1;
    bool anyNumber = false, separatedByCommas = false, mayRepeat = false;
    bool isRequired = false, isHidden = false, isFirst = false, isBesidePicture = false;
    std::vector<Conflict> conflicts;
    std::vector<std::string> needed, implied;
    Proposed proposed = Proposed::Nothing;
    Words proposals;
    /// Understands the words and keeps what they say. Throws UsageError.
    std::function<void(const Words&)> store;
};

/// The options of a command in the order in which --help lists them.
class OptionList {
  public:
    /// A heading of --help for the options declared from here on.
    void group(std::string name) { group_ = std::move(name); }

    CommandOption& flag(std::string names, std::string help, bool& where);
    CommandOption& flag(std::string names, std::string help, std::function<void()> store);
    /// An option that takes the word on or off.
    CommandOption& onOff(std::string names, std::string help, bool& where);
    CommandOption& text(std::string names, std::string valueName, std::string help,
                        std::string& where);
    CommandOption& number(std::string names, std::string valueName, std::string help,
                          uint32_t& where, Range<uint32_t> range);
    CommandOption& number(std::string names, std::string valueName, std::string help,
                          std::optional<uint32_t>& where, Range<uint32_t> range);
    /// As many whole numbers as there are places.
    CommandOption& numbers(std::string names, std::string valueNames, std::string help,
                           std::vector<uint32_t*> where, Range<uint32_t> range);
    CommandOption& real(std::string names, std::string valueName, std::string help, double& where,
                        Range<double> range);
    CommandOption& real(std::string names, std::string valueName, std::string help,
                        std::optional<double>& where, Range<double> range);
    /// A value of an enumeration with a table of names; --help lists what they mean.
    template <class E>
    CommandOption& choice(std::string names, std::string valueName, std::string help, E& where) {
        CommandOption& o = words(std::move(names), std::move(valueName),
                                 std::move(help) + " (" + allMeanings<E>() + ")", 1, {});
        o.usual = nameOf(where);
        o.proposals = namesOf<E>();
        o.store = [&where, name = o.name()](const Words& given) {
            const std::optional<E> value = valueNamed<E>(given.front());
            if (!value) refuse(name, given.front(), allNames<E>());
            where = *value;
        };
        return o;
    }
    /// Any number of words: one or more by position, or separated by commas, or repeated.
    CommandOption& list(std::string names, std::string valueName, std::string help, Words& where);
    /// An option that understands its `count` words by itself.
    CommandOption& words(std::string names, std::string valueNames, std::string help,
                         uint32_t count, std::function<void(const Words&)> store);

    const std::deque<CommandOption>& all() const { return options_; }

  private:
    std::string group_;
    std::deque<CommandOption> options_; ///< references to its elements stay valid
};

} // namespace stromboli
