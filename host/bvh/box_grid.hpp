#pragma once

#include <cstdint>

/// Boxes on the grid of a node: a byte for each plane (gpu::NodeRecord). docs/numerics.md, "Boxes",
/// derives the margins.
namespace stromboli::bvh {

/// The grid of a node on one axis: plane q lies at origin + q * cell, q = 0..255.
struct AxisGrid {
    float origin = 0;        ///< 16 significant bits: the last 8 of its 32 are 0
    uint32_t exponent = 127; ///< cell = 2^(exponent - 127); 1..254

    double cell() const;
    /// Both in one word, as gpu::NodeRecord has them.
    uint32_t word() const;
    static AxisGrid fromWord(uint32_t word);
};

/// The finest grid on which every interval within [low, high] has both bytes below. Cells are
/// at least 2^-90, so that the kernel's products with them stay normal numbers.
AxisGrid gridOver(double low, double high);

/// The highest plane that is BOX_MARGIN cells or more below `low`; `low` must lie within what
/// the grid was made for.
uint32_t planeBelow(const AxisGrid& grid, double low);

/// The lowest plane that is BOX_MARGIN cells or more above `high`.
uint32_t planeAbove(const AxisGrid& grid, double high);

} // namespace stromboli::bvh
