#include "host/checkpoint/byte_parts.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <zlib.h>

namespace stromboli {

uint32_t checksumOf(std::span<const std::byte> bytes) {
    return uint32_t(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), z_size_t(bytes.size())));
}

void append(std::vector<std::byte>& bytes, const void* data, size_t size) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}

void append(std::vector<std::byte>& bytes, const std::string& text) {
    append(bytes, uint64_t(text.size()));
    append(bytes, text.data(), text.size());
}

std::span<const std::byte> ByteParts::take(uint64_t size) {
    if (size > bytes_.size())
        throw UsageError(fmt::format("{}: the {} is cut short", file_->string(), kind_));
    const auto part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return part;
}

std::string ByteParts::text() {
    const auto part = take(number<uint64_t>());
    return {reinterpret_cast<const char*>(part.data()), part.size()};
}

} // namespace stromboli
