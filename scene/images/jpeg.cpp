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

/// Warnings are about damaged data, in whose place libjpeg would put grey.
void onJpegMessage(j_common_ptr jpeg, int level) {
    if (level < 0) onJpegError(jpeg);
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

bool readJpegRows(JpegReader& reader, uint8_t* rgba) {
    if (setjmp(reader.errors.out)) return false;
    reader.jpeg.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&reader.jpeg);
    const size_t rowSize = size_t(reader.jpeg.output_width) * 4;
    while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
        JSAMPROW row = rgba + reader.jpeg.output_scanline * rowSize;
        jpeg_read_scanlines(&reader.jpeg, &row, 1);
    }
    jpeg_finish_decompress(&reader.jpeg);
    return true;
}

} // namespace

Picture decodeJpeg(std::string_view bytes, const std::string& name) {
    JpegReader reader;
    if (!startJpeg(reader, bytes)) failToDecode(name, "JPEG", reader.errors.message);
    const bool isCmyk = reader.jpeg.num_components == 4;
    if (isCmyk) failToDecode(name, "JPEG", "it has four channels (CMYK), expected grey or colour");
    // A progressive file can describe 2^15 blocks of 8 x 8 pixels in a few bits (end-of-band runs
    // of ITU-T T.81, G.1.2.2): only the limits on the size itself bound the memory.
    requireSize(name, reader.jpeg.image_width, reader.jpeg.image_height, 4, bytes.size(), 0);
    Picture picture{reader.jpeg.image_width, reader.jpeg.image_height, {}};
    std::vector<uint8_t> values(picture.texelCount() * 4);
    if (!readJpegRows(reader, values.data())) failToDecode(name, "JPEG", reader.errors.message);
    picture.values = std::move(values);
    return picture;
}

} // namespace stromboli::images
