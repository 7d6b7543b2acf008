// TIFF ("TIFF, Revision 6.0", 1992, and its supplements): libtiff unpacks strips and tiles, of
// which this file makes a picture. What has unusual colours (palettes, inks, luminance and chroma,
// fewer bits than 8) goes through libtiff's own conversion to bytes.

#include "scene/build/read_file.hpp"
#include "scene/images/picture.hpp"
#include "scene/images/tiff_api.hpp"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

namespace stromboli::images {
namespace {

/// A file in memory, and the first thing that libtiff said is wrong with it.
struct Source {
    std::string_view bytes;
    uint64_t next = 0;
    std::string error;
};

tmsize_t readFrom(thandle_t handle, void* to, tmsize_t wanted) {
    auto& source = *static_cast<Source*>(handle);
    const uint64_t left =
        source.bytes.size() - std::min<uint64_t>(source.next, source.bytes.size());
    const uint64_t count = std::min(uint64_t(std::max<tmsize_t>(wanted, 0)), left);
    if (count > 0) std::memcpy(to, source.bytes.data() + source.next, count);
    source.next += count;
    return tmsize_t(count);
}

toff_t seekIn(thandle_t handle, toff_t offset, int from) {
    auto& source = *static_cast<Source*>(handle);
    if (from == SEEK_SET) source.next = offset;
    if (from == SEEK_CUR) source.next += offset;
    if (from == SEEK_END) source.next = source.bytes.size() + offset;
    return source.next;
}

int keepError(TIFF*, void* user, const char*, const char* format, std::va_list values) {
    auto& source = *static_cast<Source*>(user);
    std::array<char, 300> line{};
    std::vsnprintf(line.data(), line.size(), format, values);
    // Its own words for it count lines of strips.
    if (source.error.empty())
        source.error = std::string_view(line.data()).starts_with("Read error")
                           ? "the file is truncated"
                           : line.data();
    return 1;
}

/// Warnings are about tags that other programs have added.
int ignoreWarning(TIFF*, void*, const char*, const char*, std::va_list) {
    return 1;
}

struct Close {
    void operator()(TIFF* file) const { tiffApi().close(file); }
};

/// Half of what a channel can be, for what is missing, as in pictures of other formats.
template <class Value>
constexpr Value middle() {
    if constexpr (std::is_floating_point_v<Value>) return Value(0.5);
    return std::numeric_limits<Value>::max() / 2;
}

template <class Value>
constexpr Value most() {
    if constexpr (std::is_floating_point_v<Value>) return Value(1);
    return std::numeric_limits<Value>::max();
}

class TiffReader {
  public:
    TiffReader(std::string_view bytes, const std::string& name)
        : source_{bytes, 0, {}}, name_(name) {
        if (!api_.missing.empty()) failToDecode(name_, "TIFF", api_.missing);
        TIFFOpenOptions* options = api_.allocateOptions();
        // What one thing in a file may claim: a strip that is a whole picture of four floats.
        api_.limitMemory(options, tmsize_t(kLargestSide) * kLargestSide * 16);
        api_.handleErrors(options, keepError, &source_);
        api_.handleWarnings(options, ignoreWarning, nullptr);
        file_.reset(api_.open(
            "", "r", &source_, readFrom, [](thandle_t, void*, tmsize_t) { return tmsize_t(0); },
            seekIn, [](thandle_t) { return 0; },
            [](thandle_t handle) { return toff_t(static_cast<Source*>(handle)->bytes.size()); },
            [](thandle_t, void**, toff_t*) { return 0; }, [](thandle_t, void*, toff_t) {},
            options));
        api_.freeOptions(options);
        if (!file_) fail("the file is truncated or damaged");
    }

    Picture read() {
        readTags();
        requireSize(name_, width_, height_, 16, source_.bytes.size(), 0);
        const bool isPlain =
            (photometric_ == PHOTOMETRIC_MINISBLACK || photometric_ == PHOTOMETRIC_MINISWHITE ||
             photometric_ == PHOTOMETRIC_RGB) &&
            samples_ >= colorCount();
        const auto is = [&](int bits, int format) { return bits_ == bits && format_ == format; };
        Picture picture;
        if (isPlain && is(8, SAMPLEFORMAT_UINT))
            picture = readSamples<uint8_t, uint8_t>([](uint8_t value) { return value; });
        else if (isPlain && is(16, SAMPLEFORMAT_UINT))
            picture = readSamples<uint16_t, uint16_t>([](uint16_t value) { return value; });
        else if (isPlain && is(32, SAMPLEFORMAT_UINT))
            picture = readSamples<uint32_t, uint16_t>([](uint32_t v) { return uint16_t(v >> 16); });
        else if (isPlain && is(16, SAMPLEFORMAT_IEEEFP))
            picture =
                readSamples<uint16_t, float>([](uint16_t v) { return glm::unpackHalf1x16(v); });
        else if (isPlain && is(32, SAMPLEFORMAT_IEEEFP))
            picture = readSamples<float, float>([](float value) { return value; });
        else if (isPlain && is(64, SAMPLEFORMAT_IEEEFP))
            picture = readSamples<double, float>([](double value) { return float(value); });
        else
            picture = readConverted();
        if (!source_.error.empty()) picture.addFault(build::Shortfall::PicturePart, source_.error);
        return picture;
    }

  private:
    [[noreturn]] void fail(std::string_view otherwise) const {
        failToDecode(name_, "TIFF", source_.error.empty() ? otherwise : source_.error);
    }

    template <class Value>
    Value tag(uint32_t name) const {
        Value value{};
        api_.fieldOrDefault(file_.get(), name, &value);
        return value;
    }

    void readTags() {
        width_ = tag<uint32_t>(TIFFTAG_IMAGEWIDTH);
        height_ = tag<uint32_t>(TIFFTAG_IMAGELENGTH);
        samples_ = tag<uint16_t>(TIFFTAG_SAMPLESPERPIXEL);
        bits_ = tag<uint16_t>(TIFFTAG_BITSPERSAMPLE);
        format_ = tag<uint16_t>(TIFFTAG_SAMPLEFORMAT);
        if (format_ == SAMPLEFORMAT_VOID) format_ = SAMPLEFORMAT_UINT;
        orientation_ = tag<uint16_t>(TIFFTAG_ORIENTATION);
        isPlanar_ = tag<uint16_t>(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE;
        compression_ = tag<uint16_t>(TIFFTAG_COMPRESSION);
        if (!api_.field(file_.get(), TIFFTAG_PHOTOMETRIC, &photometric_))
            photometric_ = samples_ >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
        if (compression_ == COMPRESSION_JPEG && photometric_ == PHOTOMETRIC_YCBCR) {
            api_.setField(file_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
            photometric_ = PHOTOMETRIC_RGB;
        }
        uint16_t count = 0;
        const uint16_t* kinds = nullptr;
        if (api_.field(file_.get(), TIFFTAG_EXTRASAMPLES, &count, &kinds) && count > 0)
            isMultiplied_ = kinds[0] == EXTRASAMPLE_ASSOCALPHA;
    }

    unsigned colorCount() const { return photometric_ == PHOTOMETRIC_RGB ? 3 : 1; }
    bool hasAlpha() const { return samples_ > colorCount(); }

    /// A part of the picture that is packed by itself: a tile or a strip, of all samples or of one.
    struct Block {
        uint32_t x = 0, y = 0, width = 0, height = 0; ///< in the picture
        uint32_t rowLength = 0; ///< in the file, of a tile more than its width
    };

    /// Calls `put` with each block of a plane, and its unpacked bytes or null where it is damaged.
    template <class Put>
    void readBlocks(uint16_t plane, size_t bytesPerPixel, const Put& put) {
        const bool isTiled = api_.isTiled(file_.get()) != 0;
        uint32_t width = width_, height = tag<uint32_t>(TIFFTAG_ROWSPERSTRIP);
        if (isTiled) {
            width = tag<uint32_t>(TIFFTAG_TILEWIDTH);
            height = tag<uint32_t>(TIFFTAG_TILELENGTH);
        }
        height = std::min(height, isTiled ? 2 * kLargestSide : height_);
        if (width == 0 || height == 0 || width > 2 * kLargestSide) fail("its tiles have no size");
        const uint64_t size = uint64_t(width) * height * bytesPerPixel;
        const uint64_t stated =
            isTiled ? api_.tileSize(file_.get()) : api_.stripSize(file_.get(), height);
        if (size != stated) fail("its blocks have another size than their pixels");
        build::requireMemory(name_, size);
        std::vector<uint8_t> bytes(size);
        for (uint32_t y = 0; y < height_; y += height)
            for (uint32_t x = 0; x < width_; x += width) {
                const Block block{x, y, std::min(width, width_ - x), std::min(height, height_ - y),
                                  width};
                const auto wanted =
                    tmsize_t(isTiled ? size : uint64_t(width) * block.height * bytesPerPixel);
                const tmsize_t got =
                    isTiled ? api_.readTile(file_.get(), api_.tileAt(file_.get(), x, y, 0, plane),
                                            bytes.data(), wanted)
                            : api_.readStrip(file_.get(), api_.stripAt(file_.get(), y, plane),
                                             bytes.data(), wanted);
                if (got < wanted && source_.error.empty())
                    source_.error = "a part of it is too short";
                put(block, got < wanted ? nullptr : bytes.data());
            }
    }

    /// `Stored` is what the file has of a sample, which `convert` turns into a value of the
    /// picture.
    template <class Stored, class Value, class Convert>
    Picture readSamples(const Convert& convert) {
        const uint32_t colors = colorCount();
        std::vector<Value> values(size_t(width_) * height_ * 4, middle<Value>());
        for (size_t i = 3; i < values.size(); i += 4)
            values[i] = most<Value>();
        bool isAnythingThere = false;
        const unsigned inPlane = isPlanar_ ? 1 : samples_;
        const unsigned planes = isPlanar_ ? std::min<unsigned>(samples_, colors + 1) : 1;
        for (unsigned plane = 0; plane < planes; ++plane)
            readBlocks(
                uint16_t(plane), inPlane * sizeof(Stored),
                [&](const Block& block, const uint8_t* bytes) {
                    if (!bytes) return;
                    isAnythingThere = true;
                    for (uint32_t y = 0; y < block.height; ++y)
                        for (uint32_t x = 0; x < block.width; ++x) {
                            Value* const texel = &values[texelAt(block.x + x, block.y + y) * 4];
                            const uint8_t* from = bytes + (size_t(y) * block.rowLength + x) *
                                                              inPlane * sizeof(Stored);
                            for (unsigned i = 0; i < inPlane && plane + i <= colors; ++i) {
                                Stored stored;
                                std::memcpy(&stored, from + i * sizeof(Stored), sizeof(Stored));
                                put(texel, plane + i, Value(convert(stored)));
                            }
                        }
                });
        if (!isAnythingThere) fail("the file is truncated or damaged");
        if (isMultiplied_ && !std::is_floating_point_v<Value>) divideByAlpha(values);
        const bool isTurned = orientation_ > ORIENTATION_BOTLEFT;
        return {isTurned ? height_ : width_, isTurned ? width_ : height_, std::move(values)};
    }

    /// The `sample`th of a pixel: colours, then alpha.
    template <class Value>
    void put(Value* texel, unsigned sample, Value value) const {
        if (sample == colorCount()) {
            texel[3] = value;
            return;
        }
        if (photometric_ == PHOTOMETRIC_MINISWHITE) value = Value(most<Value>() - value);
        if (colorCount() == 3)
            texel[sample] = value;
        else
            texel[0] = texel[1] = texel[2] = value;
    }

    /// Where a pixel of the file is in the picture, row after row from the top.
    size_t texelAt(uint32_t x, uint32_t y) const {
        // By the tag's numbers: where the first row and the first column of the file are seen.
        const uint32_t right = width_ - 1 - x, below = height_ - 1 - y;
        switch (orientation_) {
        case ORIENTATION_TOPRIGHT:
            return size_t(y) * width_ + right;
        case ORIENTATION_BOTRIGHT:
            return size_t(below) * width_ + right;
        case ORIENTATION_BOTLEFT:
            return size_t(below) * width_ + x;
        case ORIENTATION_LEFTTOP:
            return size_t(x) * height_ + y;
        case ORIENTATION_RIGHTTOP:
            return size_t(x) * height_ + below;
        case ORIENTATION_RIGHTBOT:
            return size_t(right) * height_ + below;
        case ORIENTATION_LEFTBOT:
            return size_t(right) * height_ + y;
        default:
            return size_t(y) * width_ + x;
        }
    }

    /// Colours that the file has multiplied by alpha; elsewhere they are not.
    template <class Value>
    static void divideByAlpha(std::vector<Value>& values) {
        for (size_t i = 0; i < values.size(); i += 4) {
            const double alpha = double(values[i + 3]) / double(most<Value>());
            for (size_t c = i; alpha > 0 && alpha < 1 && c < i + 3; ++c)
                values[c] =
                    Value(std::min(std::round(double(values[c]) / alpha), double(most<Value>())));
        }
    }

    /// By libtiff's conversion to bytes, colours multiplied by alpha.
    Picture readConverted() {
        char why[1024] = "";
        if (format_ != SAMPLEFORMAT_UINT || !api_.isRgbaPossible(file_.get(), why))
            fail(why[0] ? why : "its numbers are neither whole ones above 0 nor floats");
        constexpr uint32_t kNothing = 0x007F7F7F; // what libtiff has read is opaque, or black
        std::vector<uint32_t> words(size_t(width_) * height_, kNothing);
        // An error ends the reading of a strip or tile, not that of the picture.
        api_.readRgba(file_.get(), width_, height_, words.data(), ORIENTATION_TOPLEFT, 0);
        if (std::ranges::all_of(words, [](uint32_t word) { return word == kNothing; }))
            fail("the file is truncated or damaged");
        std::vector<uint8_t> values(words.size() * 4);
        for (size_t i = 0; i < words.size(); ++i) {
            if (words[i] == kNothing) words[i] |= 0xFF000000;
            for (size_t channel = 0; channel < 4; ++channel)
                values[4 * i + channel] = uint8_t(words[i] >> (8 * channel));
        }
        divideByAlpha(values);
        Picture picture{width_, height_, std::move(values)};
        if (photometric_ == PHOTOMETRIC_SEPARATED)
            picture.addFault(build::Shortfall::PicturePart,
                             "it has four inks (CMYK); red is (1 - C)(1 - K), and so on");
        if (photometric_ == PHOTOMETRIC_LOGLUV || photometric_ == PHOTOMETRIC_LOGL)
            picture.addFault(
                build::Shortfall::PicturePart,
                "its light is packed as logarithms, of which bytes for a screen are read");
        return picture;
    }

    const TiffApi& api_ = tiffApi();
    Source source_;
    const std::string& name_;
    std::unique_ptr<TIFF, Close> file_;
    uint32_t width_ = 0, height_ = 0;
    uint16_t samples_ = 0, bits_ = 0, format_ = 0, photometric_ = 0, orientation_ = 0,
             compression_ = 0;
    bool isPlanar_ = false, isMultiplied_ = false;
};

} // namespace

Picture decodeTiff(std::string_view bytes, const std::string& name) {
    return TiffReader(bytes, name).read();
}

} // namespace stromboli::images
