#include "scene/images/picture.hpp"

#include <cstdio> // jpeglib.h uses FILE and does not include it

#include <jpeglib.h>

#include <csetjmp>

namespace stromboli::images {
namespace {

/// libjpeg reports errors by a function that must not return.
struct JpegErrors {
    jpeg_error_mgr manager; // first: libjpeg has a pointer to it
    std::jmp_buf out;
    char message[JMSG_LENGTH_MAX] = "";
    char warning[JMSG_LENGTH_MAX] = ""; ///< the first one
    bool forgives = true;
};

struct JpegReader {
    JpegErrors errors;
    jpeg_decompress_struct jpeg{};
    ~JpegReader() { jpeg_destroy_decompress(&jpeg); }
};

void onJpegError(j_common_ptr jpeg) {
    auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
    jpeg->err->format_message(jpeg, errors->message);
    std::longjmp(errors->out, 1);
}

/// Warnings are about damaged data, stray bytes or a file that ends too early: libjpeg goes on with
/// what there is. The first one is said.
void onJpegMessage(j_common_ptr jpeg, int level) {
    auto* errors = reinterpret_cast<JpegErrors*>(jpeg->err);
    if (level < 0 && !errors->forgives) onJpegError(jpeg);
    if (level < 0 && errors->warning[0] == 0) jpeg->err->format_message(jpeg, errors->warning);
}

// The functions that call setjmp own nothing, so that longjmp skips no destructor.

bool startJpeg(JpegReader& reader, std::string_view bytes) {
    reader.jpeg.err = jpeg_std_error(&reader.errors.manager);
    reader.errors.manager.error_exit = onJpegError;
    reader.errors.manager.emit_message = onJpegMessage;
    if (setjmp(reader.errors.out)) return false;
    jpeg_create_decompress(&reader.jpeg);
    jpeg_mem_src(&reader.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&reader.jpeg, TRUE);
    return true;
}

/// Four bytes a pixel: RGBA, or CMYK of pictures that are.
bool readJpegRows(JpegReader& reader, uint8_t* rgba) {
    if (setjmp(reader.errors.out)) return false;
    reader.jpeg.out_color_space = reader.jpeg.num_components == 4 ? JCS_CMYK : JCS_EXT_RGBA;
    jpeg_start_decompress(&reader.jpeg);
    const size_t rowSize = size_t(reader.jpeg.output_width) * 4;
    while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
        JSAMPROW row = rgba + reader.jpeg.output_scanline * rowSize;
        jpeg_read_scanlines(&reader.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&reader.jpeg);
    return true;
}

/// Red, green and blue in the place of cyan, magenta, yellow and black. Adobe's programs, which say
/// that they wrote a file, store 255 for no ink.
void colorsOfInks(std::vector<uint8_t>& values, bool isInverted) {
    for (size_t i = 0; i < values.size(); i += 4) {
        const auto bare = [&](size_t ink) {
            return unsigned(isInverted ? values[i + ink] : 255 - values[i + ink]);
        };
        const unsigned paper = bare(3);
        for (size_t ink = 0; ink < 3; ++ink)
            values[i + ink] = uint8_t((bare(ink) * paper + 127) / 255);
        values[i + 3] = 255;
    }
}

} // namespace

Picture decodeJpeg(std::string_view bytes, const std::string& name) {
    JpegReader reader;
    if (!startJpeg(reader, bytes)) failToDecode(name, "JPEG", reader.errors.message);
    const bool isCmyk = reader.jpeg.num_components == 4;
    // A progressive file can describe 2^15 blocks of 8 x 8 pixels in a few bits (end-of-band runs
    // of ITU-T T.81, G.1.2.2): only the limits on the size itself bound the memory.
    requireSize(name, reader.jpeg.image_width, reader.jpeg.image_height, 4, bytes.size(), 0);
    Picture picture{reader.jpeg.image_width, reader.jpeg.image_height, {}};
    // A few bytes that claim many pixels could show next to nothing, slowly.
    constexpr uint64_t manyTexels = uint64_t(1) << 22, texelsOfByte = 256;
    reader.errors.forgives =
        picture.texelCount() < manyTexels || picture.texelCount() / texelsOfByte < bytes.size();
    std::vector<uint8_t> values(picture.texelCount() * 4);
    const bool hasEnd = readJpegRows(reader, values.data());
    // What comes before an error is as good as what comes before a warning.
    if (!hasEnd && reader.jpeg.output_scanline == 0)
        failToDecode(name, "JPEG", reader.errors.message);
    const char* problem = hasEnd ? reader.errors.warning : reader.errors.message;
    if (problem[0] != 0) picture.addFault(build::Shortfall::PicturePart, problem);
    if (isCmyk) {
        colorsOfInks(values, reader.jpeg.saw_Adobe_marker);
        picture.addFault(build::Shortfall::PicturePart,
                         "it has four inks (CMYK); red is (1 - C)(1 - K), and so on");
    }
    picture.values = std::move(values);
    return picture;
}

} // namespace stromboli::images
