#include "host/core/text.hpp"

#include <charconv>
#include <limits>

namespace stromboli {
namespace {

/// digits times 10^exponent; the digits are a whole number without zeros at its start or end, empty
/// for 0.
struct Decimal {
    bool negative = false;
    std::string digits;
    int exponent = 0;
};

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

/// Takes the digits at the beginning of `text` away from it.
std::string_view takeDigits(std::string_view& text) {
    size_t count = 0;
    while (count < text.size() && isDigit(text[count]))
        ++count;
    const std::string_view digits = text.substr(0, count);
    text.remove_prefix(count);
    return digits;
}

bool take(std::string_view& text, char c) {
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
}

/// "e6" and "e-3"; empty if there is an e and no exponent behind it.
std::optional<int> takeExponent(std::string_view& text) {
    if (!take(text, 'e') && !take(text, 'E')) return 0;
    const bool negative = take(text, '-');
    if (!negative) take(text, '+');
    const std::string_view digits = takeDigits(text);
    int exponent = 0;
    // More digits than an int has are more than a double's exponent has.
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    constexpr int kMost = 1 << 20; // so that no sum below overflows
    if (digits.empty() || error != std::errc() || exponent > kMost) return std::nullopt;
    return negative ? -exponent : exponent;
}

void stripZeros(Decimal& number) {
    number.digits.erase(0, number.digits.find_first_not_of('0'));
    while (number.digits.ends_with('0')) {
        number.digits.pop_back();
        ++number.exponent;
    }
}

std::optional<Decimal> decimal(std::string_view text) {
    Decimal number;
    number.negative = take(text, '-');
    number.digits = takeDigits(text);
    if (take(text, '.')) {
        const std::string_view fraction = takeDigits(text);
        number.digits += fraction;
        number.exponent = -int(fraction.size());
    }
    if (number.digits.empty()) return std::nullopt;
    const std::optional<int> exponent = takeExponent(text);
    if (!exponent) return std::nullopt;
    number.exponent += *exponent;
    if (take(text, 'k'))
        number.exponent += 3;
    else if (take(text, 'M'))
        number.exponent += 6;
    if (!text.empty()) return std::nullopt;
    stripZeros(number);
    return number;
}

} // namespace

std::optional<uint64_t> wholeNumber(std::string_view text) {
    const std::optional<Decimal> number = decimal(text);
    if (!number) return std::nullopt;
    if (number->digits.empty()) return 0;
    // The digits do not end in 0: with a negative exponent there is a fraction.
    if (number->negative || number->exponent < 0) return std::nullopt;
    uint64_t value = 0;
    const auto [end, error] = std::from_chars(number->digits.data(),
                                              number->digits.data() + number->digits.size(), value);
    if (error != std::errc()) return std::nullopt;
    for (int i = 0; i < number->exponent; ++i) {
        if (value > std::numeric_limits<uint64_t>::max() / 10) return std::nullopt;
        value *= 10;
    }
    return value;
}

std::optional<double> realNumber(std::string_view text) {
    const std::optional<Decimal> number = decimal(text);
    if (!number) return std::nullopt;
    const std::string plain = std::string(number->negative ? "-" : "") +
                              (number->digits.empty() ? "0" : number->digits) + "e" +
                              std::to_string(number->digits.empty() ? 0 : number->exponent);
    double value = 0;
    const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    if (error != std::errc()) return std::nullopt;
    return value;
}

} // namespace stromboli
