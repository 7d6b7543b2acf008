// BC7 ("Khronos Data Format Specification" 1.3, chapter "BPTC"): a block is one of eight kinds,
// which divide its texels among up to three pairs of colours in one of 64 ways.

#include "scene/images/block_compression.hpp"

#include <bit>
#include <utility>

namespace stromboli::images {
namespace {

/// How many bits of what stand in a block of a kind.
struct Mode {
    unsigned subsets, partitionBits, rotationBits, swapBits, colorBits, alphaBits;
    bool hasBitOfEnd, hasBitOfSubset; ///< a lowest bit of all channels of an end, or of both ends
    unsigned indexBits, secondIndexBits;
};

constexpr std::array<Mode, 8> kModes = {{
    {3, 4, 0, 0, 4, 0, true, false, 3, 0},
    {2, 6, 0, 0, 6, 0, false, true, 3, 0},
    {3, 6, 0, 0, 5, 0, false, false, 2, 0},
    {2, 6, 0, 0, 7, 0, true, false, 2, 0},
    {1, 0, 2, 1, 5, 6, false, false, 2, 3},
    {1, 0, 2, 0, 7, 8, false, false, 2, 2},
    {1, 0, 0, 0, 7, 7, true, false, 4, 0},
    {2, 6, 0, 0, 5, 5, true, false, 2, 0},
}};

/// Which of two pairs a texel belongs to: a bit for each.
constexpr std::array<uint16_t, 64> kTwoSubsets = {
    0xCCCC, 0x8888, 0xEEEE, 0xECC8, 0xC880, 0xFEEC, 0xFEC8, 0xEC80, 0xC800, 0xFFEC, 0xFE80,
    0xE800, 0xFFE8, 0xFF00, 0xFFF0, 0xF000, 0xF710, 0x008E, 0x7100, 0x08CE, 0x008C, 0x7310,
    0x3100, 0x8CCE, 0x088C, 0x3110, 0x6666, 0x366C, 0x17E8, 0x0FF0, 0x718E, 0x399C, 0xAAAA,
    0xF0F0, 0x5A5A, 0x33CC, 0x3C3C, 0x55AA, 0x9696, 0xA55A, 0x73CE, 0x13C8, 0x324C, 0x3BDC,
    0x6996, 0xC33C, 0x9966, 0x0660, 0x0272, 0x04E4, 0x4E40, 0x2720, 0xC936, 0x936C, 0x39C6,
    0x639C, 0x9336, 0x9CC6, 0x817E, 0xE718, 0xCCF0, 0x0FCC, 0x7744, 0xEE22};
/// The first texel of the second pair whose index has one bit less, since its highest is 0; that of
/// the first pair is texel 0.
constexpr std::array<uint8_t, 64> kAnchorOfTwo = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2, 2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8, 2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15};
/// Which of three pairs a texel belongs to: two bits for each.
constexpr std::array<uint32_t, 64> kThreeSubsets = {
    0xAA685050, 0x6A5A5040, 0x5A5A4200, 0x5450A0A8, 0xA5A50000, 0xA0A05050, 0x5555A0A0, 0x5A5A5050,
    0xAA550000, 0xAA555500, 0xAAAA5500, 0x90909090, 0x94949494, 0xA4A4A4A4, 0xA9A59450, 0x2A0A4250,
    0xA5945040, 0x0A425054, 0xA5A5A500, 0x55A0A0A0, 0xA8A85454, 0x6A6A4040, 0xA4A45000, 0x1A1A0500,
    0x0050A4A4, 0xAAA59090, 0x14696914, 0x69691400, 0xA08585A0, 0xAA821414, 0x50A4A450, 0x6A5A0200,
    0xA9A58000, 0x5090A0A8, 0xA8A09050, 0x24242424, 0x00AA5500, 0x24924924, 0x24499224, 0x50A50A50,
    0x500AA550, 0xAAAA4444, 0x66660000, 0xA5A0A5A0, 0x50A050A0, 0x69286928, 0x44AAAA44, 0x66666600,
    0xAA444444, 0x54A854A8, 0x95809580, 0x96969600, 0xA85454A8, 0x80959580, 0xAA141414, 0x96960000,
    0xAAAA1414, 0xA05050A0, 0xA0A5A5A0, 0x96000000, 0x40804080, 0xA9A8A9A8, 0xAAAAAA44, 0x2A4A5254};
/// Such texels of the second and of the third pair.
constexpr std::array<uint8_t, 64> kSecondAnchorOfThree = {
    3,  3,  15, 15, 8, 3,  15, 15, 8,  8,  6, 6,  6, 5,  3, 3,  3,  3,  8,  15, 3,  3,
    6,  10, 5,  8,  8, 6,  8,  5,  15, 15, 8, 15, 3, 5,  6, 10, 8,  15, 15, 3,  15, 5,
    15, 15, 15, 15, 3, 15, 5,  5,  5,  8,  5, 10, 5, 10, 8, 13, 15, 12, 3,  3};
constexpr std::array<uint8_t, 64> kThirdAnchorOfThree = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8};

/// Shares of the second colour, of 64.
constexpr std::array<unsigned, 4> kWeights2 = {0, 21, 43, 64};
constexpr std::array<unsigned, 8> kWeights3 = {0, 9, 18, 27, 37, 46, 55, 64};
constexpr std::array<unsigned, 16> kWeights4 = {0,  4,  9,  13, 17, 21, 26, 30,
                                                34, 38, 43, 47, 51, 55, 60, 64};

unsigned weightOf(unsigned index, unsigned bits) {
    return bits == 2 ? kWeights2[index] : bits == 3 ? kWeights3[index] : kWeights4[index];
}

/// The bits of a block, the lowest of the first byte first.
class Bits {
  public:
    explicit Bits(std::span<const uint8_t, 16> bytes) : bytes_(bytes) {}
    unsigned next(unsigned count) {
        unsigned value = 0;
        for (unsigned i = 0; i < count; ++i, ++at_)
            value |= (bytes_[at_ / 8] >> at_ % 8 & 1u) << i;
        return value;
    }

  private:
    std::span<const uint8_t, 16> bytes_;
    unsigned at_ = 0;
};

unsigned subsetOf(const Mode& mode, unsigned partition, unsigned texel) {
    if (mode.subsets == 2) return kTwoSubsets[partition] >> texel & 1u;
    if (mode.subsets == 3) return kThreeSubsets[partition] >> 2 * texel & 3u;
    return 0;
}

bool isAnchor(const Mode& mode, unsigned partition, unsigned texel) {
    if (texel == 0) return true;
    if (mode.subsets == 2) return texel == kAnchorOfTwo[partition];
    return mode.subsets == 3 &&
           (texel == kSecondAnchorOfThree[partition] || texel == kThirdAnchorOfThree[partition]);
}

/// A byte of fewer bits, of which the highest become the lowest too.
uint8_t widened(unsigned value, unsigned bits) {
    value <<= 8 - bits;
    return uint8_t(value | value >> bits);
}

using Ends = std::array<std::array<unsigned, 4>, 6>; ///< two colours for each pair

Ends readEnds(Bits& bits, const Mode& mode) {
    Ends ends{};
    const unsigned count = 2 * mode.subsets;
    for (size_t channel = 0; channel < 4; ++channel)
        for (size_t i = 0; i < count; ++i)
            ends[i][channel] = bits.next(channel < 3 ? mode.colorBits : mode.alphaBits);
    const bool hasLowest = mode.hasBitOfEnd || mode.hasBitOfSubset;
    unsigned lowest = 0;
    for (size_t i = 0; i < count; ++i) {
        if (mode.hasBitOfEnd || (mode.hasBitOfSubset && i % 2 == 0)) lowest = bits.next(1);
        for (size_t channel = 0; channel < 4; ++channel) {
            const unsigned stated = channel < 3 ? mode.colorBits : mode.alphaBits;
            unsigned& value = ends[i][channel];
            if (hasLowest) value = value << 1 | lowest;
            value = stated == 0 ? 255 : widened(value, stated + (hasLowest ? 1 : 0));
        }
    }
    return ends;
}

} // namespace

BlockTexels decodeBc7(std::span<const uint8_t, 16> bytes) {
    BlockTexels texels{};
    const auto kind = unsigned(std::countr_zero(bytes[0]));
    if (kind >= kModes.size()) return texels;
    const Mode& mode = kModes[kind];
    Bits bits(bytes);
    bits.next(kind + 1);
    const unsigned partition = bits.next(mode.partitionBits);
    const unsigned rotation = bits.next(mode.rotationBits);
    const bool swaps = bits.next(mode.swapBits) != 0;
    const Ends ends = readEnds(bits, mode);
    std::array<unsigned, 16> colorWeights, alphaWeights;
    for (unsigned i = 0; i < 16; ++i)
        colorWeights[i] = alphaWeights[i] = weightOf(
            bits.next(mode.indexBits - (isAnchor(mode, partition, i) ? 1 : 0)), mode.indexBits);
    if (mode.secondIndexBits > 0)
        for (unsigned i = 0; i < 16; ++i)
            alphaWeights[i] =
                weightOf(bits.next(mode.secondIndexBits - (i == 0 ? 1 : 0)), mode.secondIndexBits);
    if (swaps) std::swap(colorWeights, alphaWeights);
    for (unsigned i = 0; i < 16; ++i) {
        const size_t first = 2 * size_t(subsetOf(mode, partition, i));
        for (size_t channel = 0; channel < 4; ++channel) {
            const unsigned weight = channel < 3 ? colorWeights[i] : alphaWeights[i];
            texels[i][channel] = uint8_t(
                ((64 - weight) * ends[first][channel] + weight * ends[first + 1][channel] + 32) /
                64);
        }
        if (rotation > 0) std::swap(texels[i][3], texels[i][rotation - 1]);
    }
    return texels;
}

} // namespace stromboli::images
