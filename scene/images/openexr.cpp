#include "scene/images/exr_attributes.hpp"
#include "scene/images/picture.hpp"

#include "host/core/error.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <stdexcept>

namespace stromboli::images {
namespace {

class ExrSource : public Imf::IStream {
  public:
    ExrSource(std::string_view bytes, const std::string& name)
        : Imf::IStream(name.c_str()), bytes_(bytes) {}

    bool read(char to[], int count) override {
        if (size_t(count) > bytes_.size() - next_) throw std::runtime_error("it is truncated");
        std::memcpy(to, bytes_.data() + next_, size_t(count));
        next_ += size_t(count);
        return next_ < bytes_.size();
    }
    uint64_t tellg() override { return next_; }
    void seekg(uint64_t position) override {
        if (position > bytes_.size()) throw std::runtime_error("it is truncated");
        next_ = size_t(position);
    }
    void clear() override {}

  private:
    std::string_view bytes_;
    size_t next_ = 0;
};

/// Which of the file's channels are red, green, blue and alpha; a lone Y is grey. Empty: none.
std::vector<const char*> channelsOf(const Imf::ChannelList& channels) {
    const bool coloured =
        channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B");
    if (coloured) return {"R", "G", "B", "A"};
    if (channels.findChannel("Y")) return {"Y", "Y", "Y", "A"};
    return {};
}

/// The size that the header states, checked before the library allocates tables by it.
Imath::Box2i checkedWindow(std::string_view bytes, const std::string& name) {
    constexpr uint64_t magicAndVersion = 8;
    checkExrAttributes(bytes);
    ExrSource source(bytes, name);
    source.seekg(magicAndVersion);
    int version = Imf::EXR_VERSION;
    Imf::Header header;
    header.readFrom(source, version);
    const Imath::Box2i window = header.dataWindow();
    const int64_t width = int64_t(window.max.x) - window.min.x + 1;
    const int64_t height = int64_t(window.max.y) - window.min.y + 1;
    // The table of offsets has eight bytes for each block of at most 256 rows.
    requireSize(name, uint64_t(width), uint64_t(height), 16, bytes.size(),
                uint64_t(height) / 256 * 8);
    return window;
}

Picture readExrPixels(std::string_view bytes, const std::string& name) {
    const Imath::Box2i window = checkedWindow(bytes, name);
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    ExrSource source(bytes, name);
    Imf::InputFile file(source);
    if (file.header().dataWindow() != window) throw std::runtime_error("it has several sizes");
    Picture picture{uint32_t(width), uint32_t(height), {}};
    const Imf::ChannelList& channels = file.header().channels();
    const std::vector<const char*> names = channelsOf(channels);
    if (names.empty()) throw std::runtime_error("it has neither R, G, B nor Y channels");
    if (channels.findChannel("RY") || channels.findChannel("BY"))
        throw std::runtime_error("it stores luminance and chroma, expected R, G, B");
    std::vector<float> values(picture.texelCount() * 4);
    // A channel has one place in OpenEXR's buffer: grey goes to red and is copied.
    Imf::FrameBuffer buffer;
    const bool grey = std::strcmp(names[0], "Y") == 0;
    for (int i = 0; i < 4; ++i)
        if (i == 0 || i == 3 || !grey)
            buffer.insert(names[i],
                          Imf::Slice::Make(Imf::FLOAT, values.data() + i, window, 4 * sizeof(float),
                                           4 * sizeof(float) * size_t(width), 1, 1,
                                           i == 3 ? 1.0 : 0.0));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    if (grey)
        for (size_t i = 0; i < values.size(); i += 4)
            values[i + 1] = values[i + 2] = values[i];
    picture.values = std::move(values);
    return picture;
}

} // namespace

Picture decodeExr(std::string_view bytes, const std::string& name) {
    try {
        return readExrPixels(bytes, name);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        failToDecode(name, "OpenEXR", error.what());
    }
}

} // namespace stromboli::images
