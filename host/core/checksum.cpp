#include "host/core/checksum.hpp"

#include <zlib.h>

#include <fstream>
#include <vector>

namespace stromboli {

uint32_t checksumOfFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> piece(1 << 20);
    uLong sum = crc32(0, nullptr, 0);
    while (stream) {
        stream.read(piece.data(), std::streamsize(piece.size()));
        sum = crc32_z(sum, reinterpret_cast<const Bytef*>(piece.data()), size_t(stream.gcount()));
    }
    return uint32_t(sum);
}

} // namespace stromboli
