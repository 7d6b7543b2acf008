// JPEG and WebP.
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/film/image_formats.hpp"

#include <cstdio> // jpeglib.h uses FILE and does not include it

#include <fmt/format.h>
#include <jpeglib.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include <algorithm>
#include <cerrno>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli {

namespace fs = std::filesystem;

static std::string bytesOfFile(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file)
        throw UsageError(fmt::format("{}: cannot read: {}", path.string(), std::strerror(errno)));
    return {std::istreambuf_iterator<char>(file), {}};
}

// --- JPEG ----------------------------------------------------------------------------------------

namespace {

constexpr size_t kLongestComment = 65533;

/// libjpeg reports errors by a function that must not return.
struct JpegFailure {
    jpeg_error_mgr manager; // first: libjpeg has a pointer to it
    std::jmp_buf out;
    char message[JMSG_LENGTH_MAX] = "";
};

void onJpegFailure(j_common_ptr jpeg) {
    auto* failure = reinterpret_cast<JpegFailure*>(jpeg->err);
    jpeg->err->format_message(jpeg, failure->message);
    std::longjmp(failure->out, 1);
}

void onJpegWarning(j_common_ptr, int) {}

jpeg_error_mgr* prepared(JpegFailure& failure) {
    jpeg_std_error(&failure.manager);
    failure.manager.error_exit = onJpegFailure;
    failure.manager.emit_message = onJpegWarning;
    return &failure.manager;
}

struct JpegEncoder {
    JpegFailure failure;
    jpeg_compress_struct jpeg{};
    /// As large as the file may become: libjpeg allocates a larger one otherwise, and does not say
    /// where it is when it fails.
    std::vector<unsigned char> buffer;
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    ~JpegEncoder() { jpeg_destroy_compress(&jpeg); }
};

struct JpegHeader {
    JpegFailure failure;
    jpeg_decompress_struct jpeg{};
    ~JpegHeader() { jpeg_destroy_decompress(&jpeg); }
};

// The functions that call setjmp own nothing, so that longjmp skips no destructor.

bool encodeJpeg(JpegEncoder& encoder, const ByteImage& image, uint32_t quality,
                std::span<const std::string> comments) {
    jpeg_compress_struct& jpeg = encoder.jpeg;
    jpeg.err = prepared(encoder.failure);
    if (setjmp(encoder.failure.out)) return false;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &encoder.bytes, &encoder.size);
    jpeg.image_width = image.width;
    jpeg.image_height = image.height;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, int(quality), TRUE);
    jpeg.optimize_coding = TRUE;
    // Colours for each pixel: rendered pictures have edges that no lens has softened.
    jpeg.comp_info[0].h_samp_factor = jpeg.comp_info[0].v_samp_factor = 1;
    jpeg_start_compress(&jpeg, TRUE);
    for (const std::string& comment : comments)
        jpeg_write_marker(&jpeg, JPEG_COM, reinterpret_cast<const JOCTET*>(comment.data()),
                          unsigned(comment.size()));
    while (jpeg.next_scanline < jpeg.image_height) {
        JSAMPROW row = const_cast<JSAMPROW>(image.pixel(0, jpeg.next_scanline));
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
}

bool readJpegHeader(JpegHeader& header, std::string_view bytes) {
    header.jpeg.err = prepared(header.failure);
    if (setjmp(header.failure.out)) return false;
    jpeg_create_decompress(&header.jpeg);
    jpeg_save_markers(&header.jpeg, JPEG_COM, 0xFFFF);
    jpeg_mem_src(&header.jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&header.jpeg, TRUE);
    return true;
}

} // namespace

void writeJpeg(const fs::path& path, const ByteImage& image, uint32_t quality,
               const PictureNotes& notes) {
    std::vector<std::string> comments;
    for (const PictureNote& note : notes)
        comments.push_back((note.name + ": " + note.text).substr(0, kLongestComment));
    JpegEncoder encoder;
    encoder.buffer.resize(largestPictureFile(path, image.width, image.height, {}, notes));
    encoder.bytes = encoder.buffer.data();
    encoder.size = encoder.buffer.size();
    if (!encodeJpeg(encoder, image, quality, comments))
        throw OutputError(
            fmt::format("{}: cannot encode JPEG: {}", path.string(), encoder.failure.message));
    writeOutput(path, std::as_bytes(std::span(encoder.bytes, encoder.size)));
}

PictureNotes readJpegNotes(const fs::path& path) {
    const std::string bytes = bytesOfFile(path);
    JpegHeader header;
    if (!readJpegHeader(header, bytes))
        throw UsageError(
            fmt::format("{}: cannot read JPEG: {}", path.string(), header.failure.message));
    PictureNotes notes;
    for (const jpeg_marker_struct* m = header.jpeg.marker_list; m; m = m->next) {
        const std::string comment(reinterpret_cast<const char*>(m->data), m->data_length);
        const size_t colon = comment.find(": ");
        if (colon != std::string::npos)
            notes.push_back({comment.substr(0, colon), comment.substr(colon + 2)});
    }
    return notes;
}

// --- WebP ----------------------------------------------------------------------------------------

// "WebP Container Specification" (developers.google.com/speed/webp/docs/riff_container): a RIFF
// file of chunks, of which VP8X, the first, says what else there is beside the picture.

namespace {

struct WebPEncoder {
    WebPConfig config;
    WebPPicture picture;
    WebPMemoryWriter writer;
    WebPEncoder() {
        WebPPictureInit(&picture);
        WebPMemoryWriterInit(&writer);
        picture.writer = WebPMemoryWrite;
        picture.custom_ptr = &writer;
    }
    ~WebPEncoder() {
        WebPMemoryWriterClear(&writer);
        WebPPictureFree(&picture);
    }
    std::string_view bytes() const {
        return {reinterpret_cast<const char*>(writer.mem), writer.size};
    }
};

bool importPixels(WebPPicture& picture, const ByteImage& image) {
    picture.width = int(image.width);
    picture.height = int(image.height);
    picture.use_argb = 1;
    if (image.alpha.empty())
        return WebPPictureImportRGB(&picture, image.rgb.data(), int(image.width) * 3) != 0;
    std::vector<uint8_t> rgba(image.alpha.size() * 4);
    for (size_t i = 0; i < image.alpha.size(); ++i) {
        std::copy_n(&image.rgb[3 * i], 3, &rgba[4 * i]);
        rgba[4 * i + 3] = image.alpha[i];
    }
    return WebPPictureImportRGBA(&picture, rgba.data(), int(image.width) * 4) != 0;
}

bool encodeWebP(WebPEncoder& encoder, const ByteImage& image, uint32_t quality) {
    WebPConfig& config = encoder.config;
    if (!WebPConfigInit(&config)) return false;
    config.quality = float(quality);
    config.use_sharp_yuv = 1; // it has colours for every other pixel: the best ones
    if (quality == 100) {
        config.lossless = 1;
        config.exact = 1; // also where nothing can be seen
    }
    return importPixels(encoder.picture, image) && WebPEncode(&config, &encoder.picture) != 0;
}

/// Little-endian.
std::string numberOfBytes(size_t value, int count) {
    std::string bytes;
    for (int i = 0; i < count; ++i)
        bytes += char(value >> (8 * i) & 0xFF);
    return bytes;
}

std::string chunk(const char* name, const std::string& data) {
    return name + numberOfBytes(data.size(), 4) + data + std::string(data.size() % 2, '\0');
}

constexpr std::pair<char, const char*> kXmlEntities[] = {
    {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}};
constexpr const char* kXmpPrefix = "stromboli:";

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        const auto* entity = std::ranges::find(kXmlEntities, c, [](auto& e) { return e.first; });
        safe += entity == std::end(kXmlEntities) ? std::string(1, c) : entity->second;
    }
    return safe;
}

std::string unescaped(std::string_view text) {
    std::string plain;
    for (size_t i = 0; i < text.size(); ++i) {
        const auto* entity = std::ranges::find_if(
            kXmlEntities, [&](auto& e) { return text.substr(i).starts_with(e.second); });
        plain += entity == std::end(kXmlEntities) ? text[i] : entity->first;
        if (entity != std::end(kXmlEntities)) i += std::strlen(entity->second) - 1;
    }
    return plain;
}

std::string xmpOf(const PictureNotes& notes) {
    std::string text = "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">"
                       "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">"
                       "<rdf:Description rdf:about=\"\" xmlns:stromboli=\"urn:stromboli:notes\">";
    for (const PictureNote& note : notes)
        text += fmt::format("<{0}{1}>{2}</{0}{1}>", kXmpPrefix, note.name, escaped(note.text));
    return text + "</rdf:Description></rdf:RDF></x:xmpmeta>";
}

std::string withXmp(std::string_view webp, const ByteImage& image, const std::string& xmp) {
    constexpr size_t head = 12, extension = 18;
    constexpr unsigned char hasXmp = 0x04, hasAlpha = 0x10;
    std::string_view chunks = webp.substr(head);
    if (chunks.starts_with("VP8X")) chunks.remove_prefix(extension); // of pictures with alpha
    const size_t flags = hasXmp | (image.alpha.empty() ? 0 : hasAlpha);
    const std::string what = numberOfBytes(flags, 4) + numberOfBytes(image.width - 1, 3) +
                             numberOfBytes(image.height - 1, 3);
    return chunk("RIFF", "WEBP" + chunk("VP8X", what) + std::string(chunks) + chunk("XMP ", xmp));
}

/// What its chunk of that name holds; empty if there is none.
std::string_view chunkOf(std::string_view webp, std::string_view name) {
    for (size_t at = 12; at + 8 <= webp.size();) {
        size_t size = 0;
        for (size_t i = 4; i-- > 0;)
            size = size << 8 | static_cast<unsigned char>(webp[at + 4 + i]);
        if (webp.substr(at, 4) == name) return webp.substr(at + 8, size);
        at += 8 + size + size % 2;
    }
    return {};
}

} // namespace

void writeWebP(const fs::path& path, const ByteImage& image, uint32_t quality,
               const PictureNotes& notes) {
    WebPEncoder encoder;
    if (!encodeWebP(encoder, image, quality))
        throw OutputError(fmt::format("{}: cannot encode WebP: error {}", path.string(),
                                      int(encoder.picture.error_code)));
    if (notes.empty())
        writeOutput(path, encoder.bytes());
    else
        writeOutput(path, withXmp(encoder.bytes(), image, xmpOf(notes)));
}

PictureNotes readWebPNotes(const fs::path& path) {
    const std::string bytes = bytesOfFile(path);
    WebPBitstreamFeatures features;
    if (WebPGetFeatures(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size(), &features) !=
        VP8_STATUS_OK)
        throw UsageError(
            fmt::format("{}: cannot read WebP: it is none, or damaged", path.string()));
    const std::string_view xmp = chunkOf(bytes, "XMP ");
    const std::string opening = std::string("<") + kXmpPrefix;
    PictureNotes notes;
    for (size_t at = xmp.find(opening); at != std::string::npos; at = xmp.find(opening, at)) {
        at += opening.size();
        const size_t nameEnd = xmp.find('>', at);
        if (nameEnd == std::string::npos) break;
        const std::string name(xmp.substr(at, nameEnd - at));
        const size_t end = xmp.find("</" + (kXmpPrefix + name) + ">", nameEnd);
        if (end == std::string::npos) break;
        notes.push_back({name, unescaped(xmp.substr(nameEnd + 1, end - nameEnd - 1))});
    }
    return notes;
}

} // namespace stromboli
