#include "host/film/image_formats.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/core/nearest_name.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

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

// --- OpenEXR -------------------------------------------------------------------------------------

constexpr const char* kBranches = "branches";

/// Where OpenEXR finds a channel whose first value belongs to the corner of `window`.
static Imf::Slice sliceOf(const std::vector<float>& values, const Imath::Box2i& window,
                          size_t width) {
    return Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float),
                            width * sizeof(float));
}

/// The window of pixels that a part of a picture fills, whose corner the whole has at (0, 0).
static Imath::Box2i windowOf(const Crop& part) {
    const Imath::V2i corner(int(part.x), int(part.y));
    return {corner, corner + Imath::V2i(int(part.width) - 1, int(part.height) - 1)};
}

/// Encoded in memory, because OpenEXR does not notice a disk that is full when it closes a file.
static std::string encode(const FloatImage& image, const PictureNotes& notes) {
    Imf::Header header(windowOf({0, 0, image.area.width, image.area.height}),
                       windowOf(image.area.rendered()));
    header.compression() = Imf::ZIP_COMPRESSION;
    // By itself, and no note: it says what the channels mean.
    if (image.branches > 1) header.insert(kBranches, Imf::IntAttribute(int(image.branches)));
    for (const PictureNote& note : notes)
        header.insert(note.name, Imf::StringAttribute(note.text));
    Imf::FrameBuffer frameBuffer;
    for (const auto& [name, values] : image.channels) {
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        frameBuffer.insert(name, sliceOf(values, header.dataWindow(), image.width));
    }

    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(frameBuffer);
        file.writePixels(static_cast<int>(image.height));
    } // the destructor completes the line offset table
    return stream.str();
}

/// Where the data lie in the picture that is to be shown: all there is to see, if they reach beyond
/// it.
static PictureArea areaOf(const Imath::Box2i& display, const Imath::Box2i& data) {
    const Imath::V2i size = data.max - data.min + Imath::V2i(1);
    const Imath::V2i whole = display.max - display.min + Imath::V2i(1);
    const Imath::V2i corner = data.min - display.min;
    PictureArea area{uint32_t(size.x), uint32_t(size.y), {}};
    if (data == display || !display.intersects(data.min) || !display.intersects(data.max))
        return area;
    area.crop = {uint32_t(corner.x), uint32_t(corner.y), area.width, area.height};
    area.width = uint32_t(whole.x), area.height = uint32_t(whole.y);
    return area;
}

static FloatImage decode(const fs::path& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    FloatImage image(areaOf(file.header().displayWindow(), window));
    if (const auto* branches = file.header().findTypedAttribute<Imf::IntAttribute>(kBranches))
        image.branches = uint32_t(std::max(branches->value(), 1));
    Imf::FrameBuffer frameBuffer;
    const Imf::ChannelList& channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
        if (channel.channel().xSampling != 1 || channel.channel().ySampling != 1) continue;
        frameBuffer.insert(channel.name(),
                           sliceOf(image.channel(channel.name()), window, image.width));
    }
    file.setFrameBuffer(frameBuffer);
    file.readPixels(window.min.y, window.max.y);
    return image;
}

void writeExr(const fs::path& path, const FloatImage& image, const PictureNotes& notes) {
    std::string bytes;
    try {
        bytes = encode(image, notes);
    } catch (const std::exception& error) {
        throw OutputError(fmt::format("{}: cannot encode EXR: {}", path.string(), error.what()));
    }
    writeOutput(path, std::as_bytes(std::span(bytes)));
}

namespace {

[[noreturn]] void refuseExr(const fs::path& path, const char* reason) {
    if (std::error_code failed; !fs::exists(path, failed))
        throw UsageError(
            fmt::format("{}: there is no such file{}", path.string(), didYouMeanFile(path)));
    throw UsageError(fmt::format("{}: cannot read EXR: {}", path.string(), reason));
}

} // namespace

FloatImage readExr(const fs::path& path) {
    try {
        return decode(path);
    } catch (const std::exception& error) {
        refuseExr(path, error.what());
    }
}

PictureNotes readExrNotes(const fs::path& path) {
    try {
        const Imf::InputFile file(path.c_str());
        const Imf::Header& header = file.header();
        PictureNotes notes;
        for (auto i = header.begin(); i != header.end(); ++i)
            if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&i.attribute()))
                notes.push_back({i.name(), text->value()});
        return notes;
    } catch (const std::exception& error) {
        refuseExr(path, error.what());
    }
}

// --- PFM -----------------------------------------------------------------------------------------

namespace {

/// Larger pictures on a side are taken for damaged files.
constexpr int64_t kLargestSide = 65536;

struct Header {
    uint32_t width = 0, height = 0, channels = 0;
    bool littleEndian = true;
};

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
    throw UsageError(fmt::format("{}: cannot read PFM: {}", path.string(), reason));
}

Header readHeader(std::istream& file, const fs::path& path) {
    std::string kind;
    int64_t width = 0, height = 0;
    double scale = 0;
    if (!(file >> kind) || (kind != "PF" && kind != "Pf"))
        refuse(path, "it does not begin with PF or Pf");
    if (!(file >> width >> height >> scale) || width < 1 || height < 1 || width > kLargestSide ||
        height > kLargestSide || scale == 0)
        refuse(path, "its header needs a width, a height and a scale that is not 0");
    file.get(); // the one white space before the values
    return {uint32_t(width), uint32_t(height), kind == "PF" ? 3u : 1u, scale < 0};
}

float fromBytes(const char* bytes, bool littleEndian) {
    uint32_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    if (littleEndian != (std::endian::native == std::endian::little))
        bits = __builtin_bswap32(bits);
    return std::bit_cast<float>(bits);
}

} // namespace

FloatImage readPfm(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) refuse(path, "it cannot be opened" + didYouMeanFile(path));
    const Header header = readHeader(file, path);
    FloatImage image(header.width, header.height);
    std::vector<float>* planes[3] = {};
    for (int c = 0; c < 3; ++c)
        planes[c] = &image.channel(kColorChannels[c]);
    std::vector<char> row(size_t(header.width) * header.channels * sizeof(float));
    for (uint32_t y = header.height; y-- > 0;) { // the lowest row comes first
        if (!file.read(row.data(), std::streamsize(row.size()))) refuse(path, "it is cut short");
        for (uint32_t x = 0; x < header.width; ++x)
            for (uint32_t c = 0; c < 3; ++c) {
                const size_t value = size_t(x) * header.channels + std::min(c, header.channels - 1);
                (*planes[c])[size_t(y) * header.width + x] =
                    fromBytes(&row[value * sizeof(float)], header.littleEndian);
            }
    }
    return image;
}

void writePfm(const fs::path& path, const FloatImage& image) {
    static_assert(std::endian::native == std::endian::little, "the scale below says so");
    std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
    bytes.reserve(bytes.size() + size_t(image.width) * image.height * 3 * sizeof(float));
    for (uint32_t y = image.height; y-- > 0;)
        for (uint32_t x = 0; x < image.width; ++x)
            for (const char* name : kColorChannels) {
                const float value = image.channels.at(name)[size_t(y) * image.width + x];
                char raw[sizeof value];
                std::memcpy(raw, &value, sizeof value);
                bytes.append(raw, sizeof value);
            }
    writeFileAtomically(path, std::as_bytes(std::span(bytes)));
}

} // namespace stromboli
