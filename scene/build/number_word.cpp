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

/// from_chars reports overflow and underflow alike; the exponent's sign tells them apart. Without
/// one, only hundreds of zeros after the point underflow.
bool isUnderflow(std::string_view word) {
    const size_t e = word.find_first_of("eE");
    if (e != std::string_view::npos) return e + 1 < word.size() && word[e + 1] == '-';
    const size_t digit = word.find_first_not_of("+-0");
    return digit != std::string_view::npos && word[digit] == '.';
}

/// The whole word; `error` says what from_chars had to say.
template <class T>
std::optional<T> valueOf(std::string_view word, std::errc& error) {
    T value{};
    const std::from_chars_result read =
        std::from_chars(word.data(), word.data() + word.size(), value);
    error = read.ec;
    const bool isWhole = read.ptr == word.data() + word.size();
    return isWhole && error != std::errc::invalid_argument ? std::optional(value) : std::nullopt;
}

template <class T>
std::optional<T> inRange(std::string_view word) {
    std::errc error{};
    const std::optional<T> value = valueOf<T>(word, error);
    return error == std::errc{} ? value : std::nullopt;
}

} // namespace

std::optional<double> anyRealIn(std::string_view word) {
    std::errc error{};
    const std::optional<double> value = valueOf<double>(withoutPlus(word), error);
    if (value && error == std::errc::result_out_of_range)
        return isUnderflow(word) ? 0 : std::numeric_limits<double>::infinity();
    return value;
}

std::optional<double> realIn(std::string_view word) {
    const std::optional<double> value = anyRealIn(word);
    return value && std::isfinite(*value) ? value : std::nullopt;
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

std::optional<double> realWithCommaIn(std::string_view word) {
    if (std::count(word.begin(), word.end(), ',') != 1) return std::nullopt;
    std::string pointed(word);
    std::replace(pointed.begin(), pointed.end(), ',', '.');
    return realIn(pointed);
}

std::optional<int64_t> integerIn(std::string_view word) {
    return inRange<int64_t>(withoutPlus(word));
}

std::optional<uint32_t> countIn(std::string_view word) {
    return inRange<uint32_t>(word);
}

} // namespace stromboli::build
