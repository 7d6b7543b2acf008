#include "scene/gltf/container.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <cstdint>

namespace stromboli::gltf {
namespace {

constexpr uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942; // "JSON", "BIN\0"

uint32_t wordAt(std::string_view bytes, size_t at) {
    uint32_t word = 0;
    for (size_t i = 0; i < 4; ++i)
        word |= uint32_t(uint8_t(bytes[at + i])) << (8 * i);
    return word;
}

} // namespace

bool isBinaryContainer(std::string_view bytes) {
    return bytes.starts_with("glTF");
}

Container openContainer(const std::string& file, std::string_view bytes) {
    if (!isBinaryContainer(bytes)) return {bytes, std::nullopt};
    const auto fail = [&](const std::string& message) { throw SceneError(file, 0, "", message); };
    if (bytes.size() < 12) fail("is truncated: the header of a binary file has 12 bytes");
    if (const uint32_t version = wordAt(bytes, 4); version != 2)
        fail(fmt::format("is of version {} of the binary format, expected 2", version));
    const uint32_t length = wordAt(bytes, 8);
    Container container;
    // Tools change chunks and forget the header; what the chunks state decides.
    if (length > bytes.size())
        container.problem =
            fmt::format("its header states {} bytes, it has {}", length, bytes.size());
    bytes = bytes.substr(0, length);
    size_t number = 0;
    for (size_t at = 12; at + 8 <= bytes.size(); ++number) {
        const uint32_t size = wordAt(bytes, at), kind = wordAt(bytes, at + 4);
        at += 8;
        if (size > bytes.size() - at && !container.problem.empty())
            fail("is truncated: " + container.problem);
        if (size > bytes.size() - at)
            fail(fmt::format("chunk {} states {} bytes, {} are left", number, size,
                             bytes.size() - at));
        const std::string_view chunk = bytes.substr(at, size);
        if (number == 0 && kind != kJsonChunk) fail("its first chunk is no JSON");
        if (number == 0) container.json = chunk;
        if (number == 1 && kind == kBinaryChunk) container.binary = chunk;
        at += size;
    }
    if (number == 0) fail("is truncated: it has no chunks");
    return container;
}

} // namespace stromboli::gltf
