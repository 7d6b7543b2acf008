#include "host/cli/word_spelling.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace stromboli {

bool isWholeNumber(const std::string& word) {
    return !word.empty() && std::all_of(word.begin(), word.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; });
}

namespace {

/// The two numbers of "640x360"; empty if the word is anything else.
Words joinedNumbers(const std::string& word) {
    const size_t by = word.find_first_of("xX");
    if (by == std::string::npos) return {};
    const std::string first = word.substr(0, by), second = word.substr(by + 1);
    return isWholeNumber(first) && isWholeNumber(second) ? Words{first, second} : Words{};
}

/// Whether a word names an option of which `is` holds.
bool names(const OptionList& list, const std::string& word, bool CommandOption::*is) {
    return std::ranges::any_of(list.all(), [&](const CommandOption& o) {
        const Words dashed = o.dashedNames();
        return o.*is && std::ranges::count(dashed, word) > 0;
    });
}

/// "-r 640x360" is "-r 640 360", and so is "-r=640x360"; "-r 640x360 9" is left as it is.
Words withoutJoinedNumbers(const OptionList& list, const Words& words) {
    const auto mayBeJoined = [&](const std::string& name) {
        return names(list, name, &CommandOption::mayBeJoined);
    };
    Words apart;
    for (size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        const size_t equals = word.find('=');
        const bool isBehindName =
            equals != std::string::npos && mayBeJoined(word.substr(0, equals));
        const bool isNext = !apart.empty() && mayBeJoined(apart.back());
        const Words numbers = isBehindName ? joinedNumbers(word.substr(equals + 1))
                              : isNext     ? joinedNumbers(word)
                                           : Words{};
        const bool anotherFollows = i + 1 < words.size() && isWholeNumber(words[i + 1]);
        if (numbers.empty() || anotherFollows) {
            apart.push_back(word);
            continue;
        }
        if (isBehindName) apart.push_back(word.substr(0, equals));
        apart.insert(apart.end(), numbers.begin(), numbers.end());
    }
    return apart;
}

/// "--focus 320 180" is "--focus 320,180".
Words withNumbersTogether(const OptionList& list, const Words& words) {
    Words together;
    for (size_t i = 0; i < words.size(); ++i) {
        const bool areTwo = i > 0 && i + 1 < words.size() && isWholeNumber(words[i]) &&
                            isWholeNumber(words[i + 1]) &&
                            names(list, words[i - 1], &CommandOption::mayBeApart);
        together.push_back(areTwo ? words[i] + "," + words[i + 1] : words[i]);
        if (areTwo) ++i;
    }
    return together;
}

/// "--watch room.xml" is "--watch 0 room.xml", since its number may be missing.
Words withMissingWords(const OptionList& list, const Words& words) {
    Words all;
    for (size_t i = 0; i < words.size(); ++i) {
        all.push_back(words[i]);
        for (const CommandOption& o : list.all()) {
            if (o.ifMissing.empty()) continue;
            for (const std::string& name : o.dashedNames())
                if (words[i] == name + "=")
                    throw UsageError(fmt::format("{}: expected a word behind its =", name));
            if (std::ranges::count(o.dashedNames(), words[i]) == 0) continue;
            if (i + 1 == words.size() || !o.isItsOwn(words[i + 1])) all.push_back(o.ifMissing);
        }
    }
    return all;
}

} // namespace

Words inUsualSpelling(const OptionList& list, const Words& words) {
    return withMissingWords(list, withNumbersTogether(list, withoutJoinedNumbers(list, words)));
}

Words withoutHelpCommand(const Words& words) {
    if (words.empty() || words.front() != "help") return words;
    if (words.size() == 1) return {"--help"};
    return {words[1], "--help"};
}

} // namespace stromboli
