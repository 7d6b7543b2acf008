#include "scene/assimp/stl_file.hpp"

#include "scene/model/srgb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <string_view>

namespace stromboli::assimp {
namespace {

constexpr size_t kHeader = 80, kFirstFacet = kHeader + 4, kFacet = 50;
/// Two bytes behind the corners of a facet: five bits each of three colours, and a flag.
constexpr size_t kAttribute = 48;
constexpr uint32_t kFlag = 1u << 15, kChannel = 31;

uint32_t unsignedAt(std::string_view bytes, size_t at, size_t size) {
    uint32_t value = 0;
    for (size_t i = 0; i < size; ++i)
        value |= uint32_t(uint8_t(bytes[at + i])) << (8 * i);
    return value;
}

void setUnsigned(std::string& bytes, size_t at, size_t size, uint32_t value) {
    for (size_t i = 0; i < size; ++i)
        bytes[at + i] = char(value >> (8 * i) & 0xFF);
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

bool isOfItsLength(std::string_view bytes) {
    if (bytes.size() < kFirstFacet) return false;
    const uint64_t count = unsignedAt(bytes, kHeader, 4);
    return count > 0 && bytes.size() == kFirstFacet + count * kFacet;
}

/// Headers of binary files may begin with "solid" too, and names of solids may be anything.
bool isText(std::string_view bytes) {
    const size_t first = bytes.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return false;
    constexpr std::string_view keyword = "solid";
    const std::string text = lowered(std::string(bytes.substr(first, 4096)));
    return text.starts_with(keyword) && text.find('\0') == std::string::npos &&
           (text.find("facet") != std::string::npos || text.find("endsolid") != std::string::npos);
}

std::string trimmedText(std::string bytes) {
    bytes.erase(0, bytes.find_first_not_of(" \t\r\n"));
    return bytes;
}

/// Makes the number of triangles and the length agree.
void fitLength(std::string& bytes, const build::FilePlace& place, build::Report& report) {
    if (bytes.size() < kFirstFacet)
        place.fail(fmt::format("has {} bytes: expected 'solid', or {} bytes and triangles of {} "
                               "bytes",
                               bytes.size(), kFirstFacet, kFacet));
    const uint32_t stated = unsignedAt(bytes, kHeader, 4);
    const size_t room = (bytes.size() - kFirstFacet) / kFacet;
    const size_t taken = stated == 0 ? room : std::min<size_t>(stated, room);
    if (taken == 0)
        place.fail(fmt::format("has no triangle: its header states {}, and {} bytes follow", stated,
                               bytes.size() - kFirstFacet));
    report.forgive(place,
                   fmt::format("its header states {} triangles, and {} bytes follow, which hold {}",
                               stated, bytes.size() - kFirstFacet, room),
                   fmt::format("{} are read", taken));
    bytes.resize(kFirstFacet + taken * kFacet);
    setUnsigned(bytes, kHeader, 4, uint32_t(taken));
}

/// Materialise Magics states a colour in the header, and with the flag off, red in the lowest bits,
/// those of facets that have another one. Assimp reads what VisCAM writes: the flag is on, and red
/// is in the highest bits.
std::optional<glm::vec3> takeColorsOfMagics(std::string& bytes) {
    constexpr std::string_view mark = "COLOR=";
    const size_t at = std::string_view(bytes).substr(0, kHeader).find(mark);
    if (at == std::string_view::npos || at + mark.size() + 3 > kHeader) return std::nullopt;
    glm::uvec3 whole{};
    for (int i = 0; i < 3; ++i)
        whole[i] = uint8_t(bytes[at + mark.size() + size_t(i)]);
    const auto attributeAt = [&](size_t facet) { return unsignedAt(bytes, facet + kAttribute, 2); };
    // Zeros are what programs write that know of no colours.
    const auto isOwn = [](uint32_t attribute) {
        return attribute != 0 && (attribute & kFlag) == 0;
    };
    bool hasOwn = false;
    for (size_t facet = kFirstFacet; facet < bytes.size(); facet += kFacet)
        hasOwn = hasOwn || isOwn(attributeAt(facet));
    const glm::uvec3 fifth = (whole * kChannel + 127u) / 255u;
    for (size_t facet = kFirstFacet; facet < bytes.size(); facet += kFacet) {
        const uint32_t own = attributeAt(facet);
        glm::uvec3 color = fifth;
        if (isOwn(own)) color = {own & kChannel, own >> 5 & kChannel, own >> 10 & kChannel};
        setUnsigned(bytes, facet + kAttribute, 2,
                    hasOwn ? kFlag | color.x << 10 | color.y << 5 | color.z : 0);
    }
    std::fill_n(bytes.begin() + std::ptrdiff_t(at), mark.size(), ' ');
    if (hasOwn) return std::nullopt;
    return glm::vec3(srgbToLinear(whole.x / 255.0), srgbToLinear(whole.y / 255.0),
                     srgbToLinear(whole.z / 255.0));
}

} // namespace

StlFile stlForAssimp(std::string bytes, const std::string& file, build::Report& report) {
    const build::FilePlace place{file, 0, ""};
    StlFile stl;
    if (!isOfItsLength(bytes) && isText(bytes)) {
        stl.bytes = lowered(trimmedText(std::move(bytes)));
        return stl;
    }
    if (!isOfItsLength(bytes)) fitLength(bytes, place, report);
    stl.color = takeColorsOfMagics(bytes);
    stl.bytes = std::move(bytes);
    return stl;
}

} // namespace stromboli::assimp
