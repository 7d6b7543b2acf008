#pragma once

#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli {

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

} // namespace stromboli
