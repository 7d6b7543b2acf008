// Radiance's pictures: G. Ward, "Real Pixels", Graphics Gems II, 1991, and the file format that
// Radiance's manual describes.

#include "scene/images/picture.hpp"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace stromboli::images {
namespace {

using Rgbe = std::array<uint8_t, 4>;

/// The matrix from CIE XYZ, with Y = 179 lumens to a watt left out, as Radiance writes it. Its
/// white is that of equal energy, which becomes white here too: each row of the matrix of Rec. 709
/// is divided by its sum.
const glm::dmat3 kRgbFromXyz = [] {
    glm::dmat3 rows(glm::dvec3(3.2404542, -1.5371385, -0.4985314),
                    glm::dvec3(-0.9692660, 1.8760108, 0.0415560),
                    glm::dvec3(0.0556434, -0.2040259, 1.0572252));
    for (int row = 0; row < 3; ++row)
        rows[row] /= rows[row].x + rows[row].y + rows[row].z;
    return glm::transpose(rows);
}();

/// Rows of these lengths may be packed channel by channel; all others are packed pixel by pixel.
constexpr uint32_t kShortestPackedRow = 8, kLongestPackedRow = 32767;

constexpr uint64_t kMostPixels = uint64_t(2) * kLargestSide * kLargestSide;

/// How the rows of a file lie in the picture: "-Y 2 +X 4" are two rows of four pixels from the top,
/// each from the left. All eight orders are legal.
struct Order {
    uint32_t rows = 0, pixels = 0;
    bool rowsAreColumns = false, rowsReverse = false, pixelsReverse = false;
};

/// Fills a picture by pixels. One that is too large becomes means of blocks as it is read, so that
/// it never takes the memory of all its pixels.
class Blocks {
  public:
    Blocks(uint32_t width, uint32_t height, uint32_t largestSide) {
        while ((std::max(width, height) - 1) / size_ >= largestSide)
            size_ *= 2;
        picture.width = (width - 1) / size_ + 1;
        picture.height = (height - 1) / size_ + 1;
    }
    uint32_t size() const { return size_; }
    void begin() {
        values_.assign(picture.texelCount() * 4, 0.0f);
        if (size_ > 1) counts_.assign(picture.texelCount(), 0);
    }
    void add(uint32_t x, uint32_t y, const glm::dvec3& color) {
        const size_t texel = size_t(y / size_) * picture.width + x / size_;
        float* rgba = &values_[texel * 4];
        for (int channel = 0; channel < 3; ++channel)
            rgba[channel] += float(color[channel]);
        rgba[3] = 1;
        if (size_ > 1) ++counts_[texel];
    }
    Picture finish() {
        for (size_t texel = 0; texel < counts_.size(); ++texel)
            for (size_t channel = 0; channel < 3; ++channel)
                values_[texel * 4 + channel] /= float(std::max(counts_[texel], 1u));
        picture.values = std::move(values_);
        return std::move(picture);
    }
    Picture picture;

  private:
    uint32_t size_ = 1; ///< of a block's side, in pixels of the file
    std::vector<float> values_;
    std::vector<uint32_t> counts_;
};

class HdrReader {
  public:
    HdrReader(std::string_view bytes, const std::string& name, uint32_t largestSide)
        : rest_(bytes), name_(name), largestSide_(largestSide) {}

    Picture read() {
        readVariables();
        const Order order = readSize();
        const uint32_t width = order.rowsAreColumns ? order.rows : order.pixels;
        const uint32_t height = order.rowsAreColumns ? order.pixels : order.rows;
        const bool packs = order.pixels >= kShortestPackedRow && order.pixels <= kLongestPackedRow;
        requireSides(name_, width, height, 4 * kLargestSide);
        // Repeated pixels cost a file nothing and a reader time.
        if (uint64_t(width) * height > kMostPixels)
            fail(fmt::format("{} x {} are more than {} pixels", width, height, kMostPixels));
        Blocks blocks(width, height, largestSide_);
        // Four bytes a row at least where it is packed; a repeated pixel stands for up to 2^24
        // others, so that a file of few bytes is bounded by its sides alone.
        const Picture& picture = blocks.picture;
        requireBytes(name_, width, height, rest_.size(), packs ? uint64_t(order.rows) * 4 : 4);
        requireSize(name_, picture.width, picture.height, blocks.size() > 1 ? 20 : 16, rest_.size(),
                    0);
        blocks.begin();
        std::vector<Rgbe> row(order.pixels);
        std::string problem;
        for (uint32_t i = 0; i < order.rows; ++i) {
            // Rows that are missing have no light, which is what they hold already.
            problem = readRow(row);
            if (!problem.empty() && i == 0) fail(problem);
            if (!problem.empty()) break;
            const uint32_t slow = order.rowsReverse ? order.rows - 1 - i : i;
            for (uint32_t j = 0; j < order.pixels; ++j) {
                const uint32_t fast = order.pixelsReverse ? order.pixels - 1 - j : j;
                blocks.add(order.rowsAreColumns ? slow : fast, order.rowsAreColumns ? fast : slow,
                           colorOf(row[j]));
            }
        }
        Picture read = blocks.finish();
        if (!problem.empty()) read.addFault(build::Shortfall::PicturePart, problem);
        if (blocks.size() > 1)
            read.faults.push_back({build::Shortfall::EnvironmentSize,
                                   fmt::format("has {} x {} texels, more than {} a side", width,
                                               height, largestSide_)});
        return read;
    }

  private:
    [[noreturn]] void fail(std::string_view problem) const {
        failToDecode(name_, "Radiance HDR", problem);
    }

    /// What is wrong with the pixels from somewhere on.
    struct Damage {
        std::string_view problem;
    };

    uint8_t next() {
        if (rest_.empty()) throw Damage{"the file is truncated"};
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
            if (text.starts_with("FORMAT=")) readFormat(text.substr(7));
            // Pixels were multiplied by these; several multiply.
            if (text.starts_with("EXPOSURE=")) scale_ /= glm::dvec3(readFactors<1>(text, 9)[0]);
            if (text.starts_with("COLORCORR=")) {
                const std::array<double, 3> factors = readFactors<3>(text, 10);
                scale_ /= glm::dvec3(factors[0], factors[1], factors[2]);
            }
        }
    }

    void readFormat(std::string_view text) {
        text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
        isXyz_ = text == "32-bit_rle_xyze";
        if (!isXyz_ && text != "32-bit_rle_rgbe")
            fail(fmt::format("its format is '{}', expected 32-bit_rle_rgbe or 32-bit_rle_xyze",
                             text));
    }

    /// What a variable of the header states, as numbers above 0.
    template <size_t count>
    std::array<double, count> readFactors(std::string_view line, size_t nameLength) const {
        std::array<double, count> factors{};
        std::string_view rest = line.substr(nameLength);
        for (double& factor : factors) {
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
            const auto [end, error] =
                std::from_chars(rest.data(), rest.data() + rest.size(), factor);
            if (error != std::errc() || !(factor > 0 && std::isfinite(factor)))
                fail(fmt::format("its {} is '{}', expected more than 0",
                                 count == 1 ? "exposure" : "colour correction", rest));
            rest.remove_prefix(size_t(end - rest.data()));
        }
        return factors;
    }

    /// `-Y height +X width` and the seven other orders.
    Order readSize() {
        const std::string_view text = line();
        const auto complain = [&] {
            fail(fmt::format("its size is stated as '{}', expected -Y height +X width",
                             text.substr(0, 40)));
        };
        struct Axis {
            char name = 0;
            bool isNegative = false;
            uint32_t count = 0;
        };
        std::array<Axis, 2> axes;
        std::string_view rest = text;
        for (Axis& axis : axes) {
            rest.remove_prefix(std::min(rest.find_first_not_of(' '), rest.size()));
            if (rest.size() < 4 || (rest[0] != '-' && rest[0] != '+') || rest[2] != ' ') complain();
            axis.isNegative = rest[0] == '-';
            axis.name = rest[1];
            rest.remove_prefix(3);
            const auto [end, error] =
                std::from_chars(rest.data(), rest.data() + rest.size(), axis.count);
            if (error != std::errc()) complain();
            rest.remove_prefix(size_t(end - rest.data()));
        }
        const bool isLegal = rest.empty() && ((axes[0].name == 'Y' && axes[1].name == 'X') ||
                                              (axes[0].name == 'X' && axes[1].name == 'Y'));
        if (!isLegal) complain();
        // In the file's terms y grows upwards, in a picture's rows downwards.
        const auto reverses = [](const Axis& axis) {
            return axis.name == 'Y' ? !axis.isNegative : axis.isNegative;
        };
        return {axes[0].count, axes[1].count, axes[0].name == 'X', reverses(axes[0]),
                reverses(axes[1])};
    }

    /// Returns what is wrong with the row, or nothing.
    std::string readRow(std::vector<Rgbe>& row) {
        try {
            readPackedOrPlain(row);
            return "";
        } catch (const Damage& damage) {
            return std::string(damage.problem);
        }
    }

    void readPackedOrPlain(std::vector<Rgbe>& row) {
        const size_t width = row.size();
        const Rgbe first = pixel();
        const bool packed = width >= kShortestPackedRow && width <= kLongestPackedRow &&
                            first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!packed) return readPixels(row, first);
        if ((size_t(first[2]) << 8 | first[3]) != width) throw Damage{"a row has another length"};
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
            if (count == 0 || count > row.size() - x) throw Damage{"a run is longer than its row"};
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
                if (x == 0 || shift > 16) throw Damage{"a pixel is repeated that is not there"};
                const size_t count = size_t(value[3]) << shift;
                if (count > row.size() - x) throw Damage{"a run is longer than its row"};
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
    glm::dvec3 colorOf(const Rgbe& value) const {
        const double unit = value[3] == 0 ? 0 : std::ldexp(1.0, int(value[3]) - 136);
        const glm::dvec3 color = unit * scale_ * glm::dvec3(value[0], value[1], value[2]);
        return isXyz_ ? glm::max(kRgbFromXyz * color, glm::dvec3(0)) : color;
    }

    std::string_view rest_;
    const std::string& name_;
    uint32_t largestSide_;
    glm::dvec3 scale_{1.0};
    bool isXyz_ = false;
};

} // namespace

Picture decodeHdr(std::string_view bytes, const std::string& name, uint32_t largestSide) {
    return HdrReader(bytes, name, largestSide).read();
}

} // namespace stromboli::images
