#include "tests/scene/images/encoders.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <png.h>
#include <webp/encode.h>

#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

namespace stromboli::test {
namespace {

std::string png(uint32_t width, uint32_t height, int channels, int depth, const uint8_t* values) {
    constexpr int types[] = {0, PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                             PNG_COLOR_TYPE_RGBA};
    std::string bytes;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(writer);
    png_set_write_fn(
        writer, &bytes,
        [](png_structp p, png_bytep data, size_t size) {
            static_cast<std::string*>(png_get_io_ptr(p))
                ->append(reinterpret_cast<char*>(data), size);
        },
        nullptr);
    png_set_IHDR(writer, info, width, height, depth, types[channels], PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(writer, info);
    if (depth == 16) png_set_swap(writer);
    const size_t rowSize = size_t(width) * size_t(channels) * size_t(depth) / 8;
    for (uint32_t y = 0; y < height; ++y)
        png_write_row(writer, values + y * rowSize);
    png_write_end(writer, info);
    png_destroy_write_struct(&writer, &info);
    return bytes;
}

} // namespace

std::string png8(uint32_t width, uint32_t height, int channels, std::vector<uint8_t> values) {
    return png(width, height, channels, 8, values.data());
}

std::string png16(uint32_t width, uint32_t height, int channels, std::vector<uint16_t> values) {
    return png(width, height, channels, 16, reinterpret_cast<const uint8_t*>(values.data()));
}

std::string jpeg(uint32_t width, uint32_t height, int channels, std::vector<uint8_t> values) {
    jpeg_error_mgr errors;
    jpeg_compress_struct writer;
    writer.err = jpeg_std_error(&errors);
    jpeg_create_compress(&writer);
    unsigned char* data = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&writer, &data, &size);
    writer.image_width = width, writer.image_height = height;
    writer.input_components = channels;
    writer.in_color_space = channels == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&writer);
    jpeg_set_quality(&writer, 100, TRUE);
    jpeg_start_compress(&writer, TRUE);
    while (writer.next_scanline < height) {
        JSAMPROW row = &values[size_t(writer.next_scanline) * width * size_t(channels)];
        jpeg_write_scanlines(&writer, &row, 1);
    }
    jpeg_finish_compress(&writer);
    jpeg_destroy_compress(&writer);
    std::string bytes(reinterpret_cast<char*>(data), size);
    std::free(data);
    return bytes;
}

std::string webp(uint32_t width, uint32_t height, std::vector<uint8_t> values) {
    uint8_t* data = nullptr;
    const size_t size =
        WebPEncodeLosslessRGBA(values.data(), int(width), int(height), int(width * 4), &data);
    std::string bytes(reinterpret_cast<char*>(data), size);
    WebPFree(data);
    return bytes;
}

std::string exr(uint32_t width, uint32_t height, const std::string& channels,
                std::vector<float> values, bool half) {
    std::vector<std::string> names;
    for (const char name : channels)
        names.emplace_back(1, name);
    return exr(width, height, names, std::move(values), half);
}

std::string exr(uint32_t width, uint32_t height, const std::vector<std::string>& channels,
                std::vector<float> values, bool half,
                const std::function<void(Imf::Header&)>& change) {
    Imf::Header header{int(width), int(height)};
    if (change) change(header);
    std::vector<::half> halves(values.begin(), values.end());
    Imf::FrameBuffer buffer;
    const size_t size = half ? sizeof(::half) : sizeof(float);
    char* data =
        half ? reinterpret_cast<char*>(halves.data()) : reinterpret_cast<char*>(values.data());
    for (size_t i = 0; i < channels.size(); ++i) {
        const std::string& name = channels[i];
        const Imf::PixelType type = half ? Imf::HALF : Imf::FLOAT;
        header.channels().insert(name, Imf::Channel(type));
        buffer.insert(name, Imf::Slice(type, data + i * size, size * channels.size(),
                                       size * channels.size() * width));
    }
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(buffer);
        file.writePixels(int(height));
    }
    return stream.str();
}

} // namespace stromboli::test
