// Radiance's pictures: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the file format that
// Radiance's manual describes.

#include "scene/images/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace stromboli::images {
namespace {

using Rgbe = std::array<uint8_t, 4>;

/// Rows of these lengths may be packed channel by channel; all others are packed pixel by pixel.
constexpr uint32_t kShortestPackedRow = 8, kLongestPackedRow = 32767;

class HdrReader {
  public:
    HdrReader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

    Picture read() {
        readVariables();
        Picture picture = readSize();
        const bool packs =
            picture.width >= kShortestPackedRow && picture.width <= kLongestPackedRow;
        // Four bytes a row at least where it is packed; a repeated pixel stands for up to 2^24
        // others, so that a file of few bytes is bounded by its sides alone.
        requireSize(name_, picture.width, picture.height, 16, rest_.size(),
                    packs ? uint64_t(picture.height) * 4 : 4);
        std::vector<float> values(picture.texelCount() * 4);
        std::vector<Rgbe> row(picture.width);
        for (uint32_t y = 0; y < picture.height; ++y) {
            readRow(row);
            for (uint32_t x = 0; x < picture.width; ++x)
                store(row[x], &values[(size_t(y) * picture.width + x) * 4]);
        }
        picture.values = std::move(values);
        return picture;
    }

  private:
    [[noreturn]] void fail(std::string_view problem) const {
        failToDecode(name_, "Radiance HDR", problem);
    }

    uint8_t next() {
        if (rest_.empty()) fail("the file is truncated");
        const uint8_t byte = uint8_t(rest_.front());
        rest_.remove_prefix(1);
        return byte;
    }

    std::string_view line() {
        const size_t end = rest_.find('\n');
        if (end == std::string_view::npos) fail("its header has no end");
        const std::string_view text = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return text.ends_with('\r') ? text.substr(0, text.size() - 1) : text;
    }

    void readVariables() {
        for (std::string_view text = line(); !text.empty(); text = line()) {
            if (text.starts_with("FORMAT=") && text != "FORMAT=32-bit_rle_rgbe")
                fail(fmt::format("its format is '{}', expected 32-bit_rle_rgbe", text.substr(7)));
            if (text.starts_with("EXPOSURE=")) {
                // Pixels were multiplied by it; several multiply.
                double exposure = 0;
                const size_t first = std::min(text.find_first_not_of(' ', 9), text.size());
                const std::string_view number = text.substr(first);
                std::from_chars(number.data(), number.data() + number.size(), exposure);
                if (!(exposure > 0 && std::isfinite(exposure)))
                    fail(fmt::format("its exposure is '{}', expected more than 0", number));
                scale_ /= exposure;
            }
        }
    }

    /// `-Y height +X width`: rows from the top, pixels from the left, as every program writes them.
    Picture readSize() {
        const std::string_view text = line();
        Picture picture;
        const size_t middle = text.find(" +X ");
        const bool usual = text.starts_with("-Y ") && middle != std::string_view::npos;
        const auto number = [](std::string_view digits, uint32_t& value) {
            const auto [end, error] =
                std::from_chars(digits.data(), digits.data() + digits.size(), value);
            return error == std::errc() && end == digits.data() + digits.size();
        };
        if (!usual || !number(text.substr(3, middle - 3), picture.height) ||
            !number(text.substr(middle + 4), picture.width))
            fail(fmt::format("its size is stated as '{}', expected -Y height +X width",
                             text.substr(0, 40)));
        return picture;
    }

    void readRow(std::vector<Rgbe>& row) {
        const size_t width = row.size();
        const Rgbe first = pixel();
        const bool packed = width >= kShortestPackedRow && width <= kLongestPackedRow &&
                            first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!packed) return readPixels(row, first);
        if ((size_t(first[2]) << 8 | first[3]) != width) fail("a row has another length");
        for (int channel = 0; channel < 4; ++channel)
            readChannel(row, channel);
    }

    Rgbe pixel() {
        Rgbe value;
        for (uint8_t& byte : value)
            byte = next();
        return value;
    }

    /// Runs of one channel: a count above 128 repeats the byte after it, others precede bytes.
    void readChannel(std::vector<Rgbe>& row, int channel) {
        for (size_t x = 0; x < row.size();) {
            const uint8_t code = next();
            const bool repeats = code > 128;
            const size_t count = repeats ? code - 128 : code;
            if (count == 0 || count > row.size() - x) fail("a run is longer than its row");
            const uint8_t repeated = repeats ? next() : 0;
            for (size_t i = 0; i < count; ++i)
                row[x++][channel] = repeats ? repeated : next();
        }
    }

    /// Pixels one by one; (1, 1, 1, n) repeats the last one n times, and several in a row are the
    /// digits of n in base 256, the lowest first.
    void readPixels(std::vector<Rgbe>& row, Rgbe value) {
        uint32_t shift = 0;
        for (size_t x = 0;;) {
            if (value[0] == 1 && value[1] == 1 && value[2] == 1) {
                if (x == 0 || shift > 16) fail("a pixel is repeated that is not there");
                const size_t count = size_t(value[3]) << shift;
                if (count > row.size() - x) fail("a run is longer than its row");
                for (size_t i = 0; i < count; ++i, ++x)
                    row[x] = row[x - 1];
                shift += 8;
            } else {
                row[x++] = value;
                shift = 0;
            }
            if (x == row.size()) return;
            value = pixel();
        }
    }

    /// The byte m of exponent e stands for m 2^(e - 136), of which Radiance takes the middle of the
    /// interval; other programs, and this one, take its lower end, so that black stays black.
    void store(const Rgbe& value, float* rgba) const {
        const double unit = value[3] == 0 ? 0 : std::ldexp(scale_, int(value[3]) - 136);
        for (int channel = 0; channel < 3; ++channel)
            rgba[channel] = float(value[channel] * unit);
        rgba[3] = 1;
    }

    std::string_view rest_;
    const std::string& name_;
    double scale_ = 1;
};

} // namespace

Picture decodeHdr(std::string_view bytes, const std::string& name) {
    return HdrReader(bytes, name).read();
}

} // namespace stromboli::images
