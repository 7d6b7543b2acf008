#pragma once

#include "host/core/pages.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace stromboli {

/// 16 bytes: the unit in which the kernel reads the scene (shaders/include/fetch.glsl).
using Row = std::array<uint32_t, 4>;

/// Rows that a device may read where they lie.
using RowPages = PageVector<Row>;

/// Appends the rows of a structure of shaders/shared.
template <class T>
void appendRows(std::vector<Row>& rows, const T& value) {
    static_assert(sizeof(T) % sizeof(Row) == 0 && std::is_trivially_copyable_v<T>);
    const auto words = std::bit_cast<std::array<Row, sizeof(T) / sizeof(Row)>>(value);
    for (const Row& row : words) // GCC 12 warns of a range that is inserted
        rows.push_back(row);
}

/// The structure that begins at a row. Throws std::out_of_range if it does not end among the rows.
template <class T>
T structureAt(std::span<const Row> rows, std::size_t row) {
    std::array<Row, sizeof(T) / sizeof(Row)> words;
    if (row > rows.size() || words.size() > rows.size() - row)
        throw std::out_of_range("rows of a structure");
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = rows[row + i];
    return std::bit_cast<T>(words);
}

} // namespace stromboli
