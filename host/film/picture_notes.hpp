#pragma once

#include <string>
#include <vector>

namespace stromboli {

/// What a picture's file says about the picture in words: text chunks of PNG, string attributes of
/// EXR.
struct PictureNote {
    std::string name; ///< 1 to 31 letters and digits of ASCII: PNG allows 79, EXR 31
    std::string text; ///< UTF-8 without NUL

    friend bool operator==(const PictureNote&, const PictureNote&) = default;
};
using PictureNotes = std::vector<PictureNote>;

} // namespace stromboli
