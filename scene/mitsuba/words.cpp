#include "scene/mitsuba/words.hpp"

#include "scene/build/number_word.hpp"

#include <fmt/format.h>

#include <optional>

namespace stromboli::mitsuba {
namespace {

std::string_view trimmed(std::string_view word) {
    const size_t first = word.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return {};
    return word.substr(first, word.find_last_not_of(" \t\r\n") - first + 1);
}

/// For a message, cut to a bearable length.
std::string quoted(std::string_view word) {
    return word.size() <= 40 ? fmt::format("'{}'", word)
                             : fmt::format("'{}...'", word.substr(0, 40));
}

} // namespace

std::vector<std::string_view> wordsOf(std::string_view text) {
    constexpr std::string_view kBetween = ", \t\r\n";
    std::vector<std::string_view> words;
    for (size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;) {
        const size_t end = std::min(text.find_first_of(kBetween, at), text.size());
        words.push_back(text.substr(at, end - at));
        at = text.find_first_not_of(kBetween, end);
    }
    return words;
}

double numberOf(const build::FilePlace& where, std::string_view word) {
    const std::optional<double> value = build::realIn(trimmed(word));
    if (!value) where.fail(quoted(word) + " is not a finite number");
    return *value;
}

int64_t integerOf(const build::FilePlace& where, std::string_view word) {
    const std::optional<int64_t> value = build::integerIn(trimmed(word));
    if (!value) where.fail(quoted(word) + " is not a whole number");
    return *value;
}

bool flagOf(const build::FilePlace& where, std::string_view word) {
    word = trimmed(word);
    if (word == "true" || word == "True") return true;
    if (word == "false" || word == "False") return false;
    where.fail(quoted(word) + " is neither true nor false");
}

std::vector<double> numbersOf(const build::FilePlace& where, std::string_view text) {
    std::vector<double> numbers;
    for (const std::string_view word : wordsOf(text))
        numbers.push_back(numberOf(where, word));
    return numbers;
}

glm::dvec3 vectorOf(const build::FilePlace& where, std::string_view text) {
    const std::vector<double> v = numbersOf(where, text);
    if (v.size() == 1) return glm::dvec3(v[0]);
    if (v.size() != 3) where.fail(fmt::format("has {} numbers, expected 3 or 1", v.size()));
    return {v[0], v[1], v[2]};
}

} // namespace stromboli::mitsuba
