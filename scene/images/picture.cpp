#include "scene/images/picture.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"

#include <fmt/format.h>

#include <utility>

namespace stromboli::images {

void failToDecode(const std::string& name, std::string_view format, std::string_view problem) {
    // Libraries end their messages with full stops or line breaks; a message is one line.
    std::string line(problem);
    for (char& c : line)
        if (c == '\n' || c == '\r') c = ' ';
    line.erase(line.find_last_not_of(" .") + 1);
    throw SceneError(name, 0, "", fmt::format("cannot be read as {}: {}", format, line));
}

void requireSides(const std::string& name, uint64_t width, uint64_t height, uint64_t largest) {
    if (width == 0 || height == 0 || width > largest || height > largest)
        throw SceneError(name, 0, "",
                         fmt::format("the picture has {} x {} pixels, expected at least 1 and at "
                                     "most {} of each",
                                     width, height, largest));
}

void requireBytes(const std::string& name, uint64_t width, uint64_t height, uint64_t fileBytes,
                  uint64_t leastBytes) {
    if (fileBytes < leastBytes)
        throw SceneError(name, 0, "",
                         fmt::format("claims {} x {} pixels, which {} bytes cannot hold; the file "
                                     "is truncated or damaged",
                                     width, height, fileBytes));
}

void requireSize(const std::string& name, uint64_t width, uint64_t height, uint64_t bytesPerTexel,
                 uint64_t fileBytes, uint64_t leastBytes) {
    requireSides(name, width, height, kLargestSide);
    requireBytes(name, width, height, fileBytes, leastBytes);
    build::requireMemory(name, width * height * bytesPerTexel);
}

bool isExr(std::string_view bytes) {
    return bytes.starts_with("\x76\x2f\x31\x01");
}

namespace {

/// Either byte order, with offsets of 32 or of 64 bits.
bool isTiff(std::string_view bytes) {
    using namespace std::string_view_literals;
    const std::string_view mark = bytes.substr(0, 4);
    return mark == "II*\0"sv || mark == "MM\0*"sv || mark == "II+\0"sv || mark == "MM\0+"sv;
}

/// What is known of pictures that are not read, for the message about them.
std::string whatItIs(std::string_view bytes) {
    using namespace std::string_view_literals;
    constexpr std::pair<std::string_view, const char*> kinds[] = {
        {"8BPS"sv, "Photoshop's PSD"},   {"\xABKTX"sv, "KTX"}, {"\xFF\x0A"sv, "JPEG XL"},
        {"\0\0\0\x0CJXL "sv, "JPEG XL"}, {"<svg"sv, "SVG"},    {"\0\0\0\x0CjP"sv, "JPEG 2000"}};
    for (const auto& [mark, name] : kinds)
        if (bytes.starts_with(mark))
            return fmt::format("is a picture in {}, which is not read", name);
    const std::string_view kind = bytes.size() < 12 ? "" : bytes.substr(4, 8);
    if (kind == "ftypavif") return "is a picture in AVIF, which is not read";
    if (kind == "ftypheic" || kind == "ftypmif1") return "is a picture in HEIF, which is not read";
    return "is no picture that is read";
}

} // namespace

Picture decodePicture(std::string_view bytes, const std::string& name, uint32_t largestSide) {
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return decodePng(bytes, name);
    if (bytes.starts_with("\xFF\xD8\xFF")) return decodeJpeg(bytes, name);
    if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP"))
        return decodeWebp(bytes, name);
    if (bytes.starts_with("GIF8")) return decodeGif(bytes, name);
    if (bytes.starts_with("BM")) return decodeBmp(bytes, name);
    if (bytes.starts_with("#?")) return decodeHdr(bytes, name, largestSide);
    if (isExr(bytes)) return decodeExr(bytes, name);
    if (isTiff(bytes)) return decodeTiff(bytes, name);
    if (bytes.starts_with("DDS ")) return decodeDds(bytes, name);
    if (bytes.starts_with("PF") || bytes.starts_with("Pf")) return decodePfm(bytes, name);
    if (looksLikeTga(bytes)) return decodeTga(bytes, name);
    throw SceneError(name, 0, "",
                     bytes.empty()
                         ? "is empty, expected a picture"
                         : whatItIs(bytes) + ": expected PNG, JPEG, WebP, GIF, BMP, "
                                             "TIFF, DDS, Radiance HDR, OpenEXR, PFM or TGA");
}

} // namespace stromboli::images
