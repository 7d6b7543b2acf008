#include "host/film/image_formats.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/nearest_name.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <span>
#include <string>

namespace stromboli {

namespace fs = std::filesystem;

// libpng reports errors by longjmp, which must not skip destructors: the functions that call
// setjmp own nothing, and the objects live in their callers.

static void onError(png_structp png, png_const_charp message) {
    static_cast<std::string*>(png_get_error_ptr(png))->assign(message);
    png_longjmp(png, 1);
}

static void onWarning(png_structp, png_const_charp) {}

static void append(png_structp png, png_bytep data, size_t size) {
    auto* bytes = static_cast<std::vector<png_byte>*>(png_get_io_ptr(png));
    bytes->insert(bytes->end(), data, data + size);
}

static void flush(png_structp) {}

namespace {

struct Writer {
    std::string error;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, onError, onWarning);
    png_infop info = png_create_info_struct(png);
    Writer() {
        if (!info) throw std::bad_alloc();
    }
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Reader {
    std::string error;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, onError, onWarning);
    png_infop info = png_create_info_struct(png);
    Reader() {
        if (!info) throw std::bad_alloc();
    }
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

} // namespace

/// The notes as libpng takes them; they point into them. tEXt chunks hold Latin-1: what goes beyond
/// ASCII becomes iTXt, which holds UTF-8.
static std::vector<png_text> textsOf(const PictureNotes& notes) {
    std::vector<png_text> texts;
    for (const PictureNote& note : notes) {
        const bool isAscii = std::all_of(note.text.begin(), note.text.end(), [](char c) {
            return static_cast<unsigned char>(c) < 128;
        });
        png_text& text = texts.emplace_back();
        text.compression = isAscii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        text.key = const_cast<png_charp>(note.name.c_str());
        text.text = const_cast<png_charp>(note.text.c_str());
        text.text_length = isAscii ? note.text.size() : 0;
        text.itxt_length = isAscii ? 0 : note.text.size();
    }
    return texts;
}

namespace {

/// The rows of a picture as PNG has them: alpha, where there is any, behind each colour.
template <class Value>
class Rows {
  public:
    explicit Rows(const ScreenImage<Value>& image) : image_(image) {
        if (!image.alpha.empty()) row_.resize(size_t(image.width) * 4);
    }
    png_const_bytep row(uint32_t y) {
        if (row_.empty()) return reinterpret_cast<png_const_bytep>(image_.pixel(0, y));
        for (uint32_t x = 0; x < image_.width; ++x) {
            std::copy_n(image_.pixel(x, y), 3, &row_[size_t(x) * 4]);
            row_[size_t(x) * 4 + 3] = image_.alpha[size_t(y) * image_.width + x];
        }
        return reinterpret_cast<png_const_bytep>(row_.data());
    }

  private:
    const ScreenImage<Value>& image_;
    std::vector<Value> row_;
};

} // namespace

template <class Value>
static bool encode(png_structp png, png_infop info, const ScreenImage<Value>& image,
                   Rows<Value>& rows, PngColorSpace colorSpace, std::span<const png_text> texts,
                   std::vector<png_byte>& bytes) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_write_fn(png, &bytes, append, flush);
    png_set_IHDR(png, info, image.width, image.height, 8 * sizeof(Value),
                 image.alpha.empty() ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (colorSpace == PngColorSpace::Srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_RELATIVE);
    if (!texts.empty()) png_set_text(png, info, texts.data(), int(texts.size()));
    png_write_info(png, info);
    if constexpr (sizeof(Value) > 1 && std::endian::native == std::endian::little)
        png_set_swap(png); // the file's order is big-endian
    for (uint32_t y = 0; y < image.height; ++y)
        png_write_row(png, rows.row(y));
    png_write_end(png, info);
    return true;
}

static bool decode(png_structp png, png_infop info, std::FILE* file) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_read_png(png, info,
                 PNG_TRANSFORM_EXPAND | PNG_TRANSFORM_SCALE_16 | PNG_TRANSFORM_GRAY_TO_RGB,
                 nullptr);
    return true;
}

template <class Value>
static void writeAnyPng(const fs::path& path, const ScreenImage<Value>& image,
                        PngColorSpace colorSpace, const PictureNotes& notes) {
    const std::vector<png_text> texts = textsOf(notes);
    Writer writer;
    Rows rows(image);
    std::vector<png_byte> bytes;
    if (!encode(writer.png, writer.info, image, rows, colorSpace, texts, bytes))
        throw OutputError(fmt::format("{}: cannot encode PNG: {}", path.string(), writer.error));
    writeOutput(path, std::as_bytes(std::span(bytes)));
}

void writePng(const fs::path& path, const ByteImage& image, PngColorSpace colorSpace,
              const PictureNotes& notes) {
    writeAnyPng(path, image, colorSpace, notes);
}

void writePng(const fs::path& path, const WordImage& image, PngColorSpace colorSpace,
              const PictureNotes& notes) {
    writeAnyPng(path, image, colorSpace, notes);
}

/// Throws UsageError.
static void readInto(Reader& reader, const fs::path& path) {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                               &std::fclose);
    if (!file)
        throw UsageError(fmt::format("{}: cannot read: {}{}", path.string(), std::strerror(errno),
                                     didYouMeanFile(path)));
    if (!decode(reader.png, reader.info, file.get()))
        throw UsageError(fmt::format("{}: cannot read PNG: {}", path.string(), reader.error));
}

ByteImage readPng(const fs::path& path) {
    Reader reader;
    readInto(reader, path);
    ByteImage image(png_get_image_width(reader.png, reader.info),
                    png_get_image_height(reader.png, reader.info));
    png_bytepp rows = png_get_rows(reader.png, reader.info);
    const bool hasAlpha = png_get_channels(reader.png, reader.info) == 4;
    if (hasAlpha) image.alpha.resize(size_t(image.width) * image.height);
    const size_t bytes = hasAlpha ? 4 : 3;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            png_const_bytep pixel = rows[y] + bytes * x;
            std::copy_n(pixel, 3, image.pixel(x, y));
            if (hasAlpha) image.alpha[size_t(y) * image.width + x] = pixel[3];
        }
    return image;
}

PictureNotes readPngNotes(const fs::path& path) {
    Reader reader;
    readInto(reader, path);
    png_textp texts = nullptr;
    const png_uint_32 count = png_get_text(reader.png, reader.info, &texts, nullptr);
    PictureNotes notes;
    for (png_uint_32 i = 0; i < count; ++i)
        notes.push_back({texts[i].key, texts[i].text ? texts[i].text : ""});
    return notes;
}

} // namespace stromboli
