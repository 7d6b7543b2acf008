#include "host/view/frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stromboli::view {
namespace {

void append(std::string& bytes, uint64_t value, int count) {
    for (int i = 0; i < count; ++i)
        bytes += char(value >> (8 * i) & 0xFF);
}

} // namespace

uint16_t halfOf(float value) {
    if (std::isnan(value)) return 0;
    const auto bits = std::bit_cast<uint32_t>(value);
    const auto sign = uint16_t(bits >> 16 & 0x8000);
    const uint32_t size = bits & 0x7FFFFFFF;
    if (size >= 0x477FF000) return sign | 0x7C00; // 65520 and more round to infinity
    if (size < 0x38800000) {                      // below 2^-14 halves are multiples of 2^-24
        const float magnitude = std::bit_cast<float>(size);
        return uint16_t(sign | uint16_t(std::nearbyint(std::ldexp(magnitude, 24))));
    }
    const uint32_t rounded = size + 0xFFF + (size >> 13 & 1); // to nearest, to even
    return uint16_t(sign | uint16_t((rounded - 0x38000000) >> 13));
}

int exponentFor(std::span<const float> values) {
    float most = 0;
    for (const float value : values)
        if (std::isfinite(value)) most = std::max(most, std::abs(value));
    if (most == 0 || (most <= 32768 && most >= 1.0f / 256)) return 0;
    return std::ilogb(most) - 14;
}

std::string encodeFrame(std::string json, const Raster& raster, int exponent) {
    if (json.size() % 2 != 0) json += ' ';
    std::string bytes;
    bytes.reserve(4 + json.size() + 2 * raster.values.size());
    append(bytes, json.size(), 4);
    bytes += json;
    const double scale = std::ldexp(1.0, -exponent); // a float would overflow
    for (const float value : raster.values)
        append(bytes, halfOf(exponent == 0 ? value : float(double(value) * scale)), 2);
    return bytes;
}

} // namespace stromboli::view
