#pragma once

#include <OpenEXR/ImfHeader.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stromboli::test {

/// The bytes of PNG files. `channels`: 1 grey, 2 grey and alpha, 3 colour, 4 colour and alpha.
std::string png8(uint32_t width, uint32_t height, int channels, std::vector<uint8_t> values);
std::string png16(uint32_t width, uint32_t height, int channels, std::vector<uint16_t> values);
/// A JPEG file of colour or grey, at the best quality.
std::string jpeg(uint32_t width, uint32_t height, int channels, std::vector<uint8_t> values);
/// Lossless, of colour and alpha.
std::string webp(uint32_t width, uint32_t height, std::vector<uint8_t> values);
/// An OpenEXR file of the channels named by the letters, interleaved in `values`; half floats or
/// floats.
std::string exr(uint32_t width, uint32_t height, const std::string& channels,
                std::vector<float> values, bool half);
/// An OpenEXR file with channels of any names, and what `change` does to the header.
std::string exr(uint32_t width, uint32_t height, const std::vector<std::string>& channels,
                std::vector<float> values, bool half,
                const std::function<void(Imf::Header&)>& change = {});

} // namespace stromboli::test
