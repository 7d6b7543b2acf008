#include "host/film/exr.hpp"

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStdIO.h>
#include <fmt/format.h>

namespace stromboli {

namespace fs = std::filesystem;

/// Where OpenEXR finds a channel whose first value belongs to the corner of `window`.
static Imf::Slice sliceOf(const std::vector<float>& values, const Imath::Box2i& window,
                          size_t width) {
    return Imf::Slice::Make(Imf::FLOAT, values.data(), window, sizeof(float),
                            width * sizeof(float));
}

/// Encoded in memory, because OpenEXR does not notice a disk that is full when it closes a file.
static std::string encode(const FloatImage& image) {
    Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
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

static FloatImage decode(const fs::path& path) {
    Imf::InputFile file(path.c_str());
    const Imath::Box2i window = file.header().dataWindow();
    FloatImage image(static_cast<uint32_t>(window.max.x - window.min.x + 1),
                     static_cast<uint32_t>(window.max.y - window.min.y + 1));
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

void writeExr(const fs::path& path, const FloatImage& image) {
    std::string bytes;
    try {
        bytes = encode(image);
    } catch (const std::exception& error) {
        throw OutputError(fmt::format("{}: cannot encode EXR: {}", path.string(), error.what()));
    }
    writeFileAtomically(path, std::as_bytes(std::span(bytes)));
}

FloatImage readExr(const fs::path& path) {
    try {
        return decode(path);
    } catch (const std::exception& error) {
        throw UsageError(fmt::format("{}: cannot read EXR: {}", path.string(), error.what()));
    }
}

} // namespace stromboli
