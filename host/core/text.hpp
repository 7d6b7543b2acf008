#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli {

// --- Names of values -----------------------------------------------------------------------------

/// A value of an enumeration, its name on the command line and in files, and what it means.
template <class E>
struct NamedValue {
    E value;
    const char* name;
    const char* meaning;
};

/// All values of an enumeration: specialised, as a std::array, next to each enumeration that users
/// choose from.
template <class E>
inline constexpr std::array<NamedValue<E>, 0> kNamedValues{};

/// The row of the table that has this value; every value has one.
template <class E>
constexpr const NamedValue<E>& rowOf(E value) {
    static_assert(!kNamedValues<E>.empty(), "this enumeration has no table of names");
    for (const NamedValue<E>& row : kNamedValues<E>)
        if (row.value == value) return row;
    std::abort(); // a table that leaves a value out
}

template <class E>
constexpr const char* nameOf(E value) {
    return rowOf(value).name;
}

template <class E>
constexpr const char* meaningOf(E value) {
    return rowOf(value).meaning;
}

/// The value of that name; empty if there is none.
template <class E>
constexpr std::optional<E> valueNamed(std::string_view name) {
    for (const NamedValue<E>& row : kNamedValues<E>)
        if (row.name == name) return row.value;
    return std::nullopt;
}

/// "a, b or c".
template <class E>
std::string allNames() {
    std::string text;
    const auto& rows = kNamedValues<E>;
    for (size_t i = 0; i < rows.size(); ++i)
        text += (i == 0 ? "" : i + 1 == rows.size() ? " or " : ", ") + std::string(rows[i].name);
    return text;
}

/// "a: what it means; b: what it means", for --help.
template <class E>
std::string allMeanings() {
    std::string text;
    for (const NamedValue<E>& row : kNamedValues<E>)
        text += (text.empty() ? "" : "; ") + std::string(row.name) + ": " + row.meaning;
    return text;
}

// --- Numbers -------------------------------------------------------------------------------------

/// Numbers as users write them: decimal digits, with a point, an exponent, and k or M for thousands
/// and millions, as in "12", "0.05", "2.5k", "1e6", "4M". Nothing else: no spaces, no NaN, no
/// infinity. Empty if the whole text is no such number, or is one that the type cannot hold.

/// A number without a fraction, exactly: "2.5k" is 2500, "1.5" is none.
std::optional<uint64_t> wholeNumber(std::string_view text);
/// The double nearest to the number; empty too where that would be 0 for a number that is not.
std::optional<double> realNumber(std::string_view text);

} // namespace stromboli
