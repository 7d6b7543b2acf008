#include "scene/images/exr_attributes.hpp"
#include "scene/images/exr_channels.hpp"
#include "scene/images/exr_colors.hpp"
#include "scene/images/picture.hpp"

#include "host/core/error.hpp"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

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

int64_t widthOf(const Imath::Box2i& window) {
    return int64_t(window.max.x) - window.min.x + 1;
}
int64_t heightOf(const Imath::Box2i& window) {
    return int64_t(window.max.y) - window.min.y + 1;
}

/// The sizes that the first header states, checked before the library allocates tables by them.
void checkWindows(std::string_view bytes, const std::string& name) {
    constexpr uint64_t magicAndVersion = 8;
    checkExrAttributes(bytes);
    ExrSource source(bytes, name);
    source.seekg(magicAndVersion);
    int version = Imf::EXR_VERSION;
    Imf::Header header;
    header.readFrom(source, version);
    const Imath::Box2i window = header.dataWindow();
    // The table of offsets has eight bytes for each block of at most 256 rows.
    requireSize(name, uint64_t(widthOf(window)), uint64_t(heightOf(window)), 16, bytes.size(),
                uint64_t(heightOf(window)) / 256 * 8);
}

/// The part that is shown: the first one with a layer of colours, of those that have one without a
/// name or the likeliest name.
struct ShownPart {
    int number = 0;
    ExrChannels channels;
};

std::vector<std::string> namesOf(const Imf::ChannelList& channels) {
    std::vector<std::string> names;
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
        names.emplace_back(channel.name());
    return names;
}

ExrMeaning meaningOf(const Imf::Header& header) {
    ExrMeaning meaning;
    if (Imf::hasChromaticities(header)) {
        const Imf::Chromaticities& c = Imf::chromaticities(header);
        meaning.chromaticities = {c.red.x,  c.red.y,  c.green.x, c.green.y,
                                  c.blue.x, c.blue.y, c.white.x, c.white.y};
    }
    if (Imf::hasEnvmap(header)) {
        meaning.isLatLong = Imf::envmap(header) == Imf::ENVMAP_LATLONG;
        meaning.isCube = Imf::envmap(header) == Imf::ENVMAP_CUBE;
    }
    return meaning;
}

ShownPart shownPart(const Imf::MultiPartInputFile& file) {
    std::optional<ShownPart> shown;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& header = file.header(part);
        // Deep pictures have any number of samples in a pixel.
        if (header.hasType() && Imf::isDeepData(header.type())) continue;
        const std::optional<ExrChannels> channels = exrChannels(namesOf(header.channels()));
        if (!channels) continue;
        const bool isBetter = !shown || (shown->channels.isGrey && !channels->isGrey);
        if (isBetter) shown = ShownPart{part, *channels};
    }
    if (shown) return *shown;
    std::string names;
    for (int part = 0; part < file.parts(); ++part)
        for (const std::string& name : namesOf(file.header(part).channels()))
            if (names.size() < 200) names += (names.empty() ? "" : ", ") + name;
    throw std::runtime_error(fmt::format("it has neither R, G, B nor Y channels, but {}", names));
}

ShownPart partWithLayer(const Imf::MultiPartInputFile& file, const std::string& layer) {
    std::string layers;
    for (int part = 0; part < file.parts(); ++part) {
        const Imf::Header& header = file.header(part);
        if (header.hasType() && Imf::isDeepData(header.type())) continue;
        const std::vector<std::string> names = namesOf(header.channels());
        if (const auto channels = exrChannelsOf(names, layer)) return {part, *channels};
        if (header.hasName() && header.name() == layer)
            if (const auto channels = exrChannelsOf(names, "")) return {part, *channels};
        for (const std::string& name : exrLayers(names))
            if (!name.empty()) layers += (layers.empty() ? "" : ", ") + name;
    }
    throw std::runtime_error(fmt::format("it has no layer '{}' with colours{}", layer,
                                         layers.empty() ? "" : ", but " + layers));
}

/// A channel that is there for every other column or row only.
struct Subsampled {
    size_t place; ///< of the four of a pixel
    size_t xs, ys, columns, rows;
    std::vector<float> values;
};

/// Interpolates its numbers to all pixels.
void spread(const Subsampled& channel, size_t width, size_t height, std::vector<float>& rgba) {
    const std::vector<float>& values = channel.values;
    const size_t columns = channel.columns, rows = channel.rows;
    for (size_t y = 0; y < height; ++y)
        for (size_t x = 0; x < width; ++x) {
            const double u = double(x) / double(channel.xs), v = double(y) / double(channel.ys);
            const size_t left = size_t(u), top = size_t(v);
            const size_t right = std::min(left + 1, columns - 1);
            const size_t lower = std::min(top + 1, rows - 1);
            const double a = u - double(left), b = v - double(top);
            rgba[(y * width + x) * 4 + channel.place] =
                float((1 - b) * ((1 - a) * values[top * columns + left] +
                                 a * values[top * columns + right]) +
                      b * ((1 - a) * values[lower * columns + left] +
                           a * values[lower * columns + right]));
        }
}

/// Reads all rows into the part's frame buffer; where `problem` is given, those before and those
/// behind the ones that cannot be read, and what is wrong with these. Throws if there are none.
void readRows(Imf::InputPart& part, std::string* problem) {
    const Imath::Box2i window = part.header().dataWindow();
    try {
        return part.readPixels(window.min.y, window.max.y);
    } catch (const std::exception& error) {
        if (!problem) throw;
        *problem = error.what();
    }
    // The library may tell of an error at the next call once more: a row is tried twice.
    const auto isRead = [&](int y) {
        for (int i = 0; i < 2; ++i)
            try {
                part.readPixels(y, y);
                return true;
            } catch (const std::exception&) {
            }
        return false;
    };
    int first = window.min.y, last = window.max.y;
    while (first <= last && isRead(first))
        ++first;
    while (last > first && isRead(last))
        --last;
    if (first == window.min.y && last == window.max.y) throw std::runtime_error(*problem);
}

/// Red, green, blue and alpha of the data window. All channels are read at once: their blocks are
/// compressed together. `problem`: as of readRows().
std::vector<float> readColors(Imf::InputPart& part, const ExrChannels& channels,
                              std::string* problem) {
    const Imath::Box2i window = part.header().dataWindow();
    const auto width = size_t(widthOf(window)), height = size_t(heightOf(window));
    std::vector<float> rgba(width * height * 4, 0.0f);
    std::vector<Subsampled> subsampled;
    Imf::FrameBuffer buffer;
    const auto add = [&](const std::string& channel, size_t place) {
        const Imf::Channel* stated = part.header().channels().findChannel(channel);
        const int xs = stated->xSampling, ys = stated->ySampling;
        if (xs == 1 && ys == 1) {
            buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, rgba.data() + place, window,
                                                    4 * sizeof(float), 4 * sizeof(float) * width));
            return;
        }
        Subsampled s{place,
                     size_t(xs),
                     size_t(ys),
                     (width - 1) / size_t(xs) + 1,
                     (height - 1) / size_t(ys) + 1,
                     {}};
        s.values.resize(s.columns * s.rows);
        buffer.insert(channel, Imf::Slice::Make(Imf::FLOAT, s.values.data(), window, sizeof(float),
                                                sizeof(float) * s.columns, xs, ys));
        subsampled.push_back(std::move(s));
    };
    for (size_t i = 0; i < 3; ++i)
        if (!channels.color[i].empty() && (i == 0 || !channels.isGrey)) add(channels.color[i], i);
    if (!channels.alpha.empty()) add(channels.alpha, 3);
    part.setFrameBuffer(buffer);
    readRows(part, problem);
    for (const Subsampled& s : subsampled)
        spread(s, width, height, rgba);
    for (size_t i = 0; channels.alpha.empty() && i < rgba.size(); i += 4)
        rgba[i + 3] = 1;
    for (size_t i = 0; channels.isGrey && i < rgba.size(); i += 4)
        rgba[i + 1] = rgba[i + 2] = rgba[i];
    if (channels.isLuminance) colorsOfLuminance(meaningOf(part.header()), rgba);
    if (!channels.isGrey) toRec709(meaningOf(part.header()), rgba);
    return rgba;
}

/// The picture is the display window; what lies beyond the data in it is black and not there.
Picture inDisplayWindow(const std::string& name, const Imf::Header& header,
                        std::vector<float> rgba) {
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    Picture picture{uint32_t(widthOf(data)), uint32_t(heightOf(data)), {}};
    const bool isSame = data == display || widthOf(display) < 1 || heightOf(display) < 1;
    if (isSame) {
        picture.values = std::move(rgba);
        return picture;
    }
    requireSize(name, uint64_t(widthOf(display)), uint64_t(heightOf(display)), 32, 0, 0);
    picture = Picture{uint32_t(widthOf(display)), uint32_t(heightOf(display)), {}};
    std::vector<float> values(picture.texelCount() * 4, 0.0f);
    for (int64_t y = std::max(data.min.y, display.min.y); y <= std::min(data.max.y, display.max.y);
         ++y)
        for (int64_t x = std::max(data.min.x, display.min.x);
             x <= std::min(data.max.x, display.max.x); ++x) {
            const auto from = size_t((y - data.min.y) * widthOf(data) + x - data.min.x) * 4;
            const auto to = size_t((y - display.min.y) * widthOf(display) + x - display.min.x) * 4;
            std::copy_n(rgba.begin() + ptrdiff_t(from), 4, values.begin() + ptrdiff_t(to));
        }
    picture.values = std::move(values);
    return picture;
}

/// The colours of a part, checked before they take memory.
std::vector<float> readChecked(Imf::InputPart& part, const ExrChannels& channels,
                               std::string_view bytes, const std::string& name,
                               std::string* problem) {
    const Imath::Box2i window = part.header().dataWindow();
    requireSize(name, uint64_t(widthOf(window)), uint64_t(heightOf(window)), 24, bytes.size(),
                uint64_t(heightOf(window)) / 256 * 8);
    return readColors(part, channels, problem);
}

Picture readExrPixels(std::string_view bytes, const std::string& name) {
    checkWindows(bytes, name);
    ExrSource source(bytes, name);
    Imf::MultiPartInputFile file(source);
    const ShownPart shown = shownPart(file);
    Imf::InputPart part(file, shown.number);
    std::string problem;
    Picture picture = inDisplayWindow(name, part.header(),
                                      readChecked(part, shown.channels, bytes, name, &problem));
    picture = asEnvironment(meaningOf(part.header()), std::move(picture));
    if (!problem.empty()) picture.addFault(build::Shortfall::PicturePart, problem);
    return picture;
}

PicturePart readExrLayer(std::string_view bytes, const std::string& name,
                         const std::string& layer) {
    checkWindows(bytes, name);
    ExrSource source(bytes, name);
    Imf::MultiPartInputFile file(source);
    const ShownPart shown = layer.empty() ? shownPart(file) : partWithLayer(file, layer);
    Imf::InputPart part(file, shown.number);
    const Imath::Box2i data = part.header().dataWindow(), whole = part.header().displayWindow();
    PicturePart result{{uint32_t(widthOf(data)), uint32_t(heightOf(data)), {}}};
    // What is to be compared or shown by itself is whole, or an error.
    result.picture.values = readChecked(part, shown.channels, bytes, name, nullptr);
    const bool isInside = whole.intersects(data.min) && whole.intersects(data.max);
    const Imath::Box2i& frame = isInside ? whole : data;
    result.left = uint32_t(data.min.x - frame.min.x);
    result.top = uint32_t(data.min.y - frame.min.y);
    result.width = uint32_t(widthOf(frame));
    result.height = uint32_t(heightOf(frame));
    return result;
}

/// What `read` reads, with errors as the other decoders have them.
template <class Read>
auto readingExr(const std::string& name, const Read& read) {
    try {
        return read();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        failToDecode(name, "OpenEXR", error.what());
    }
}

} // namespace

Picture decodeExr(std::string_view bytes, const std::string& name) {
    return readingExr(name, [&] { return readExrPixels(bytes, name); });
}

PicturePart decodeExrLayer(std::string_view bytes, const std::string& name,
                           const std::string& layer) {
    return readingExr(name, [&] { return readExrLayer(bytes, name, layer); });
}

} // namespace stromboli::images
