#include "scene/images/picture.hpp"

#include <png.h>

#include <cstring>
#include <limits>
#include <new>

namespace stromboli::images {
namespace {

/// Deflate turns at most 1032 bytes into one (zlib's technical notes): fewer are no whole picture.
constexpr uint64_t kDeflateRatio = 1032;

struct PngSource {
    std::string_view bytes;
    size_t next = 0;
    std::string error, damage;
    uint64_t rowsRead = 0; ///< of all passes of interlaced pictures
};

void onPngError(png_structp png, png_const_charp message) {
    static_cast<PngSource*>(png_get_error_ptr(png))->error.assign(message);
    png_longjmp(png, 1);
}

/// A wrong checksum of pixels is the only warning that may be about what is seen. Names of chunks
/// that matter begin with a capital.
void onPngWarning(png_structp png, png_const_charp message) {
    const std::string_view text(message);
    const bool matters = !text.empty() && text[0] >= 'A' && text[0] <= 'Z';
    auto* source = static_cast<PngSource*>(png_get_error_ptr(png));
    if (matters && text.ends_with("CRC error")) source->damage = text;
}

void onPngRow(png_structp png, png_uint_32, int) {
    ++static_cast<PngSource*>(png_get_io_ptr(png))->rowsRead;
}

void readFromMemory(png_structp png, png_bytep to, size_t count) {
    auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
    if (count > source->bytes.size() - source->next) png_error(png, "the file is truncated");
    std::memcpy(to, source->bytes.data() + source->next, count);
    source->next += count;
}

struct PngReader {
    PngSource source;
    png_structp png =
        png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, onPngError, onPngWarning);
    png_infop info = png_create_info_struct(png);
    explicit PngReader(std::string_view bytes) : source{bytes, 0, {}, {}, 0} {
        if (!info) throw std::bad_alloc();
        png_set_read_fn(png, &source, readFromMemory);
        png_set_read_status_fn(png, onPngRow);
        // What libpng asks for at a time is lost where the file ends within it.
        png_set_compression_buffer_size(png, 512);
        png_set_crc_action(png, PNG_CRC_WARN_USE, PNG_CRC_DEFAULT);
    }
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

// libpng reports errors by longjmp, which must not skip destructors: the functions that call
// setjmp own nothing, and the objects live in their caller.

/// Asks for RGBA of 8 or 16 bits, whatever the file has.
bool readPngHeader(png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_user_limits(png, kLargestSide, kLargestSide);
    png_read_info(png, info);
    png_set_expand(png); // palettes, transparent colours and fewer bits than 8
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xFFFF, PNG_FILLER_AFTER);
    if (png_get_bit_depth(png, info) == 16) png_set_swap(png); // the file's order is big-endian
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return true;
}

bool readPngRows(png_structp png, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    png_read_end(png, nullptr);
    return true;
}

/// Reads as many rows as there are, and whether these are all. What is missing stays mid grey, as
/// it does in JPEG pictures.
template <class Value>
bool readPngValues(PngReader& reader, Picture& picture) {
    constexpr Value most = std::numeric_limits<Value>::max();
    std::vector<Value> values(picture.texelCount() * 4, most / 2);
    for (size_t i = 3; i < values.size(); i += 4)
        values[i] = most;
    std::vector<png_bytep> rows(picture.height);
    for (size_t y = 0; y < rows.size(); ++y)
        rows[y] = reinterpret_cast<png_bytep>(&values[y * picture.width * 4]);
    const bool areAll = readPngRows(reader.png, rows.data());
    picture.values = std::move(values);
    return areAll;
}

} // namespace

Picture decodePng(std::string_view bytes, const std::string& name) {
    PngReader reader(bytes);
    if (!readPngHeader(reader.png, reader.info)) failToDecode(name, "PNG", reader.source.error);
    Picture picture{png_get_image_width(reader.png, reader.info),
                    png_get_image_height(reader.png, reader.info),
                    {}};
    const bool deep = png_get_bit_depth(reader.png, reader.info) == 16;
    // Bytes of the file's own pixels, which a palette may pack eight to a byte.
    const uint64_t leastBits = picture.texelCount() * (deep ? 16 : 1);
    requireSize(name, picture.width, picture.height, deep ? 8 : 4, bytes.size(),
                leastBits / 8 / kDeflateRatio);
    const bool read =
        deep ? readPngValues<uint16_t>(reader, picture) : readPngValues<uint8_t>(reader, picture);
    if (!read && reader.source.rowsRead == 0) failToDecode(name, "PNG", reader.source.error);
    const std::string& problem = read ? reader.source.damage : reader.source.error;
    if (!problem.empty()) picture.addFault(build::Shortfall::PicturePart, problem);
    return picture;
}

} // namespace stromboli::images
