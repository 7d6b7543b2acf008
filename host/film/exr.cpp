#include "host/film/exr.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"

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

namespace stromboli {

namespace fs = std::filesystem;

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

FloatImage readExr(const fs::path& path) {
    try {
        return decode(path);
    } catch (const std::exception& error) {
        throw UsageError(fmt::format("{}: cannot read EXR: {}", path.string(), error.what()));
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
        throw UsageError(fmt::format("{}: cannot read EXR: {}", path.string(), error.what()));
    }
}

} // namespace stromboli
