#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

/// CRC-32.
uint32_t checksumOf(std::span<const std::byte> bytes);

// What files of saved renders are made of, in this machine's byte order.

void append(std::vector<std::byte>& bytes, const void* data, size_t size);
/// Its length, then its bytes.
void append(std::vector<std::byte>& bytes, const std::string& text);
template <class T>
requires std::is_arithmetic_v<T>
void append(std::vector<std::byte>& bytes, T value) {
    append(bytes, &value, sizeof value);
}

/// Takes parts of a file from its beginning. Throws UsageError that names the file, and what it is
/// ("checkpoint"), if it has no more.
class ByteParts {
  public:
    ByteParts(const std::filesystem::path& file, std::string kind, std::span<const std::byte> bytes)
        : file_(&file), kind_(std::move(kind)), bytes_(bytes) {}

    std::span<const std::byte> take(uint64_t size);
    template <class T>
    T number() {
        T value{};
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string text();
    std::span<const std::byte> rest() const { return bytes_; }

  private:
    const std::filesystem::path* file_;
    std::string kind_;
    std::span<const std::byte> bytes_;
};

/// Fewer bytes that say the same, made at some hundred megabytes a second.
std::vector<std::byte> compressed(std::span<const std::byte> bytes);

/// The `size` bytes that were compressed; nothing if they were others or another number.
std::optional<std::vector<std::byte>> decompressed(std::span<const std::byte> bytes, uint64_t size);

} // namespace stromboli
