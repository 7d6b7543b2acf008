#include "host/film/pfm.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <span>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChannels[] = {"R", "G", "B"};
/// Larger pictures on a side are taken for damaged files.
constexpr int64_t kLargestSide = 65536;

struct Header {
    uint32_t width = 0, height = 0, channels = 0;
    bool littleEndian = true;
};

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
    throw UsageError(fmt::format("{}: cannot read PFM: {}", path.string(), reason));
}

Header readHeader(std::istream& file, const fs::path& path) {
    std::string kind;
    int64_t width = 0, height = 0;
    double scale = 0;
    if (!(file >> kind) || (kind != "PF" && kind != "Pf"))
        refuse(path, "it does not begin with PF or Pf");
    if (!(file >> width >> height >> scale) || width < 1 || height < 1 || width > kLargestSide ||
        height > kLargestSide || scale == 0)
        refuse(path, "its header needs a width, a height and a scale that is not 0");
    file.get(); // the one white space before the values
    return {uint32_t(width), uint32_t(height), kind == "PF" ? 3u : 1u, scale < 0};
}

float fromBytes(const char* bytes, bool littleEndian) {
    uint32_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    if (littleEndian != (std::endian::native == std::endian::little))
        bits = __builtin_bswap32(bits);
    return std::bit_cast<float>(bits);
}

} // namespace

FloatImage readPfm(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse(path, "it cannot be opened");
    const Header header = readHeader(file, path);
    FloatImage image(header.width, header.height);
    std::vector<float>* planes[3] = {};
    for (int c = 0; c < 3; ++c)
        planes[c] = &image.channel(kChannels[c]);
    std::vector<char> row(size_t(header.width) * header.channels * sizeof(float));
    for (uint32_t y = header.height; y-- > 0;) { // the lowest row comes first
        if (!file.read(row.data(), std::streamsize(row.size()))) refuse(path, "it is cut short");
        for (uint32_t x = 0; x < header.width; ++x)
            for (uint32_t c = 0; c < 3; ++c) {
                const size_t value = size_t(x) * header.channels + std::min(c, header.channels - 1);
                (*planes[c])[size_t(y) * header.width + x] =
                    fromBytes(&row[value * sizeof(float)], header.littleEndian);
            }
    }
    return image;
}

void writePfm(const fs::path& path, const FloatImage& image) {
    static_assert(std::endian::native == std::endian::little, "the scale below says so");
    std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
    bytes.reserve(bytes.size() + size_t(image.width) * image.height * 3 * sizeof(float));
    for (uint32_t y = image.height; y-- > 0;)
        for (uint32_t x = 0; x < image.width; ++x)
            for (const char* name : kChannels) {
                const float value = image.channels.at(name)[size_t(y) * image.width + x];
                char raw[sizeof value];
                std::memcpy(raw, &value, sizeof value);
                bytes.append(raw, sizeof value);
            }
    writeFileAtomically(path, std::as_bytes(std::span(bytes)));
}

} // namespace stromboli
