#include "scene/images/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>

namespace stromboli::images {
namespace {

/// The next word of the header and the one blank behind it.
std::string_view takeWord(std::string_view& rest) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n"), rest.size()));
    const size_t end = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    const std::string_view word = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return word;
}

float floatAt(std::string_view bytes, size_t at, bool isLittle) {
    uint32_t bits = 0;
    for (size_t i = 0; i < 4; ++i)
        bits |= uint32_t(uint8_t(bytes[at + i])) << 8 * (isLittle ? i : 3 - i);
    return std::bit_cast<float>(bits);
}

} // namespace

/// Rows run from the bottom up; a scale below 0 says that the lowest byte of a number is first, and
/// its size says nothing, as nearly all programs have it.
Picture decodePfm(std::string_view bytes, const std::string& name) {
    std::string_view rest = bytes;
    const std::string_view kind = takeWord(rest);
    if (kind != "PF" && kind != "Pf" && kind != "PF4")
        failToDecode(name, "PFM", fmt::format("it begins with '{}'", kind.substr(0, 40)));
    const size_t channels = kind == "PF4" ? 4 : kind == "PF" ? 3 : 1; // PF4: with alpha
    uint64_t sides[2] = {0, 0};
    for (uint64_t& side : sides) {
        const std::string_view word = takeWord(rest);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), side);
        if (error != std::errc() || end != word.data() + word.size())
            failToDecode(name, "PFM", fmt::format("'{}' is no size", word.substr(0, 40)));
    }
    const bool isLittle = takeWord(rest).starts_with('-');
    const auto [width, height] = sides;
    requireSides(name, width, height, kLargestSide);
    requireSize(name, width, height, 4 * sizeof(float), rest.size(), width * height * channels * 4);
    Picture picture{uint32_t(width), uint32_t(height), std::vector<float>()};
    auto& values = std::get<std::vector<float>>(picture.values);
    values.reserve(4 * picture.texelCount());
    for (uint64_t row = 0; row < height; ++row)
        for (uint64_t column = 0; column < width; ++column) {
            const size_t at = 4 * channels * ((height - 1 - row) * width + column);
            for (size_t channel = 0; channel < 3; ++channel)
                values.push_back(floatAt(rest, at + 4 * (channels >= 3 ? channel : 0), isLittle));
            values.push_back(channels == 4 ? floatAt(rest, at + 12, isLittle) : 1);
        }
    return picture;
}

} // namespace stromboli::images
