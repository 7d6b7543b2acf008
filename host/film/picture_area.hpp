#pragma once

#include <cstdint>

namespace stromboli {

/// A part of a picture, in pixels from the top left corner of the whole.
struct Crop {
    uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// A pixel of the whole picture: column, row from the top.
struct PixelPlace {
    uint32_t x = 0, y = 0;
};

/// Which pixels a picture has and which of them are rendered.
struct PictureArea {
    uint32_t width = 800, height = 600; ///< of the whole picture, before the crop
    Crop crop;                          ///< width 0: the whole picture

    /// What is rendered: the crop, or the whole picture where there is none.
    Crop rendered() const { return crop.width == 0 ? Crop{0, 0, width, height} : crop; }
    /// Column and row, in the whole picture, of a pixel that is rendered: `index` counts these row
    /// by row.
    PixelPlace placeOf(uint32_t index) const {
        const Crop part = rendered();
        return {part.x + index % part.width, part.y + index / part.width};
    }
    /// The number of pixels that are rendered.
    uint64_t pixelCount() const {
        const Crop part = rendered();
        return uint64_t(part.width) * part.height;
    }
};

/// Whether the same pixels of a picture of the same size are rendered.
inline bool sameArea(const PictureArea& a, const PictureArea& b) {
    const Crop x = a.rendered(), y = b.rendered();
    return a.width == b.width && a.height == b.height && x.x == y.x && x.y == y.y &&
           x.width == y.width && x.height == y.height;
}

} // namespace stromboli
