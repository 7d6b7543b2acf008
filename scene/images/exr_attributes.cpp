#include "scene/images/exr_attributes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

namespace stromboli::images {
namespace {

/// Types of one size ("OpenEXR File Layout", section "Predefined Attribute Types").
struct FixedType {
    std::string_view name;
    uint32_t bytes;
};
constexpr auto kFixedTypes =
    std::to_array<FixedType>({{"box2i", 16},      {"box2f", 16},   {"chromaticities", 32},
                              {"compression", 1}, {"double", 8},   {"envmap", 1},
                              {"float", 4},       {"int", 4},      {"keycode", 28},
                              {"lineOrder", 1},   {"m33f", 36},    {"m44f", 64},
                              {"m33d", 72},       {"m44d", 128},   {"rational", 8},
                              {"tiledesc", 9},    {"timecode", 8}, {"v2i", 8},
                              {"v2f", 8},         {"v2d", 16},     {"v3i", 12},
                              {"v3f", 12},        {"v3d", 24},     {"deepImageState", 1}});

[[noreturn]] void fail(const char* problem) {
    throw std::runtime_error(problem);
}

/// A part of the file that is read from its beginning.
class Reader {
  public:
    explicit Reader(std::string_view bytes) : left_(bytes) {}

    bool atEnd() const { return left_.empty(); }
    uint32_t word() {
        const std::string_view b = take(4);
        return uint32_t(uint8_t(b[0])) | uint32_t(uint8_t(b[1])) << 8 |
               uint32_t(uint8_t(b[2])) << 16 | uint32_t(uint8_t(b[3])) << 24;
    }
    std::string_view text() {
        const size_t end = left_.find('\0');
        if (end == std::string_view::npos) fail("it is truncated");
        const std::string_view text = left_.substr(0, end);
        left_.remove_prefix(end + 1);
        return text;
    }
    std::string_view take(size_t count) {
        if (count > left_.size()) fail("it is truncated");
        const std::string_view taken = left_.substr(0, count);
        left_.remove_prefix(count);
        return taken;
    }

  private:
    std::string_view left_;
};

/// Channels, each a name and 16 bytes, up to an empty name.
void checkChannels(Reader value) {
    while (!value.text().empty())
        value.take(16);
    if (!value.atEnd()) fail("its list of channels has another length than it says");
}

void checkPreview(Reader value) {
    const uint64_t width = value.word(), height = value.word();
    if (width > 0xFFFF || height > 0xFFFF) fail("its preview is too large");
    value.take(size_t(4 * width * height));
    if (!value.atEnd()) fail("its preview has another length than it says");
}

void checkTexts(Reader value) {
    while (!value.atEnd())
        value.take(value.word());
}

void checkValue(std::string_view type, std::string_view value) {
    for (const FixedType& fixed : kFixedTypes)
        if (type == fixed.name && value.size() != fixed.bytes)
            fail("an attribute has another length than its type");
    if (type == "chlist") checkChannels(Reader(value));
    if (type == "preview") checkPreview(Reader(value));
    if (type == "stringvector") checkTexts(Reader(value));
}

/// True if it has attributes.
bool checkHeader(Reader& file) {
    bool hasSome = false;
    for (; !file.text().empty(); hasSome = true) {
        const std::string_view type = file.text();
        const uint32_t bytes = file.word();
        checkValue(type, file.take(bytes));
    }
    return hasSome;
}

} // namespace

void checkExrAttributes(std::string_view bytes) {
    constexpr uint32_t kSeveralParts = 0x1000; // a flag of the version
    Reader file(bytes);
    file.word(); // what all of these files begin with
    const bool several = (file.word() & kSeveralParts) != 0;
    while (checkHeader(file) && several) {
    } // of several headers the last one is empty
}

} // namespace stromboli::images
