#include "scene/build/number_word.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace stromboli::build {
namespace {

/// from_chars takes a minus and no plus.
std::string_view withoutPlus(std::string_view word) {
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
    return word;
}

} // namespace

std::optional<double> realIn(std::string_view word) {
    word = withoutPlus(word);
    double value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size()) return std::nullopt;
    // Out of range is said of both ends of the range.
    const bool isTiny = error == std::errc::result_out_of_range &&
                        (word.find("e-") != word.npos || word.find("E-") != word.npos);
    if (isTiny) return 0.0;
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<double> realOrNanIn(std::string_view word) {
    if (const std::optional<double> value = realIn(word)) return value;
    std::string small(word.substr(0, 16));
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    std::string_view rest = small;
    if (rest.starts_with('-') || rest.starts_with('+')) rest.remove_prefix(1);
    for (const std::string_view name : {"nan", "inf", "1.#ind", "1.#qnan", "1.#snan", "1.#inf"})
        if (rest.starts_with(name)) return std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
}

std::optional<int64_t> integerIn(std::string_view word) {
    word = withoutPlus(word);
    int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
    return value;
}

} // namespace stromboli::build
