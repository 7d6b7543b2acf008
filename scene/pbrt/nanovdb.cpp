#include "scene/pbrt/nanovdb.hpp"

#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/pbrt/usable_value.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace stromboli::pbrt {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Bytes of a file, none of which is read that is not there.
class Bytes {
  public:
    Bytes(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    [[noreturn]] void fail(const std::string& problem) const {
        throw SceneError(file_, 0, "", problem);
    }
    uint64_t size() const { return bytes_.size(); }
    Bytes part(uint64_t from, uint64_t size) const {
        if (from > bytes_.size() || size > bytes_.size() - from) fail("ends too early");
        return {bytes_.substr(from, size), file_};
    }
    template <class T>
    T at(uint64_t place) const {
        T value;
        std::memcpy(&value, part(place, sizeof value).bytes_.data(), sizeof value);
        return value;
    }
    std::string_view text() const { return bytes_; }
    const std::string& file() const { return file_; }

  private:
    std::string_view bytes_;
    const std::string& file_;
};

// --- The layout ----------------------------------------------------------------------------------

// A file is a row of segments: a header, a description of each grid with its name, and the grids.
// A grid is its own header, that of the tree, the root with its tiles, and all nodes of each level
// one after the other. Nodes of all levels are arrays here, so that no offset has to be followed
// from one to another.

struct Segment {
    static constexpr uint64_t kBytes = 16, kVersion = 8, kGridCount = 12, kCodec = 14;
};
struct Description {
    static constexpr uint64_t kBytes = 176, kGridSize = 0, kSizeInFile = 8, kNameSize = 136;
};
enum class Codec : uint16_t { None = 0, Zip = 1, Blosc = 2 };

struct GridHeader {
    static constexpr uint64_t kBytes = 672, kVersion = 16, kSize = 32, kName = 40, kNameBytes = 256,
                              kMatrix = 384, kOffset = 528, kType = 636;
};
constexpr uint32_t kFloats = 1; ///< the type of a grid

struct TreeHeader {
    static constexpr uint64_t kBytes = 64, kOffsets = 0, kCounts = 32;
};
struct Root {
    static constexpr uint64_t kBytes = 64, kTileCount = 24, kBackground = 28, kTileBytes = 32,
                              kTileChild = 8, kTileValue = 20;
};

/// Nodes above the leaves: children along a side, voxels along a side of a child.
struct Level {
    uint32_t bits, childBits;
    uint64_t bytes, childMask, table;
};
constexpr Level kUpper{5, 7, 270400, 4128, 8256}, kLower{4, 3, 33856, 544, 1088};
constexpr uint64_t kEntryBytes = 8;

struct Leaf {
    static constexpr uint64_t kBytes = 2144, kValues = 96;
    static constexpr uint32_t kBits = 3;
};

using Place = glm::vec<3, int64_t>;

/// The numbered cell of a node; z changes fastest.
Place cellOf(uint32_t number, uint32_t bits) {
    const uint32_t mask = (1u << bits) - 1;
    return {number >> 2 * bits & mask, number >> bits & mask, number & mask};
}

/// A tree of floats in the bytes of its grid.
class Tree {
  public:
    explicit Tree(const Bytes& grid) : grid_(grid) {
        const uint64_t tree = GridHeader::kBytes;
        for (uint32_t level = 0; level < 4; ++level)
            offsets_[level] = tree + grid.at<uint64_t>(tree + TreeHeader::kOffsets + 8ull * level);
        for (uint32_t level = 0; level < 3; ++level)
            counts_[level] = grid.at<uint32_t>(tree + TreeHeader::kCounts + 4ull * level);
        if (grid.at<float>(offsets_[3] + Root::kBackground) > 0)
            grid.fail("has a grid without an end: expected a background of 0");
    }

    /// Calls take(low, side, value) for each cube of voxels that has one value above 0: from the
    /// corner `low`, so many on a side.
    template <class Take>
    void forEach(const Take& take) const {
        forTiles();
        forNodes(kUpper, 2, take);
        forNodes(kLower, 1, take);
        const Bytes leaves = nodes(0, Leaf::kBytes);
        requireApart(leaves, Leaf::kBytes, Leaf::kBits);
        for (uint64_t leaf = 0; leaf < leaves.size(); leaf += Leaf::kBytes) {
            const Place low = originOf(leaves, leaf, Leaf::kBits);
            for (uint32_t i = 0; i < 1u << 3 * Leaf::kBits; ++i) {
                const float value =
                    usable(double(leaves.at<float>(leaf + Leaf::kValues + 4ull * i)));
                if (value > 0) take(low + cellOf(i, Leaf::kBits), int64_t(1), value);
            }
        }
    }

  private:
    Bytes nodes(uint32_t level, uint64_t bytes) const {
        return grid_.part(counts_[level] > 0 ? offsets_[level] : 0, counts_[level] * bytes);
    }
    /// Throws if two nodes are in one place: the work of reading them has no bound then.
    static void requireApart(const Bytes& nodes, uint64_t bytes, uint32_t bits) {
        std::vector<std::array<int64_t, 3>> places;
        for (uint64_t node = 0; node < nodes.size(); node += bytes) {
            const Place p = originOf(nodes, node, bits);
            places.push_back({p.x, p.y, p.z});
        }
        std::ranges::sort(places);
        if (std::ranges::adjacent_find(places) != places.end())
            nodes.fail("is damaged: two nodes of its tree are in one place");
    }
    /// Nodes begin with their least active voxel.
    static Place originOf(const Bytes& nodes, uint64_t node, uint32_t bits) {
        Place low;
        for (int i = 0; i < 3; ++i)
            low[i] =
                int64_t(nodes.at<int32_t>(node + 4ull * uint64_t(i))) & ~((int64_t(1) << bits) - 1);
        return low;
    }

    /// Tiles of the root are 4096 voxels on a side: too many to be meant.
    void forTiles() const {
        const auto count = grid_.at<uint32_t>(offsets_[3] + Root::kTileCount);
        const Bytes tiles = grid_.part(offsets_[3] + Root::kBytes, count * Root::kTileBytes);
        for (uint64_t tile = 0; tile < tiles.size(); tile += Root::kTileBytes)
            if (tiles.at<int64_t>(tile + Root::kTileChild) == 0 &&
                tiles.at<float>(tile + Root::kTileValue) > 0)
                grid_.fail("has a cube of 4096 voxels on a side of one density: expected smaller "
                           "ones");
    }

    template <class Take>
    void forNodes(const Level& level, uint32_t number, const Take& take) const {
        const Bytes all = nodes(number, level.bytes);
        requireApart(all, level.bytes, level.bits + level.childBits);
        for (uint64_t node = 0; node < all.size(); node += level.bytes) {
            const Place low = originOf(all, node, level.bits + level.childBits);
            for (uint32_t i = 0; i < 1u << 3 * level.bits; ++i) {
                const auto mask = all.at<uint64_t>(node + level.childMask + 8ull * (i / 64));
                if (mask >> i % 64 & 1) continue; // its node has the values
                const float value =
                    usable(double(all.at<float>(node + level.table + kEntryBytes * i)));
                if (value > 0)
                    take(low + (cellOf(i, level.bits) << int64_t(level.childBits)),
                         int64_t(1) << level.childBits, value);
            }
        }
    }

    const Bytes& grid_;
    uint64_t offsets_[4];
    uint64_t counts_[3];
};

/// From voxels to the file's own space; the middle of a voxel is where its number says.
glm::dmat4 spaceOf(const Bytes& grid) {
    glm::dmat4 matrix(1.0);
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            matrix[column][row] =
                grid.at<double>(GridHeader::kMatrix + 8ull * uint64_t(3 * row + column));
        matrix[3][row] = grid.at<double>(GridHeader::kOffset + 8ull * uint64_t(row));
    }
    const double volume = std::abs(glm::determinant(matrix));
    if (!std::isfinite(volume) || volume == 0) grid.fail("has a grid without a volume");
    return matrix;
}

NanoGrid inCells(const Bytes& bytes, uint64_t mostCells) {
    const Tree tree(bytes);
    Place low(std::numeric_limits<int64_t>::max()), high(std::numeric_limits<int64_t>::min());
    tree.forEach([&](const Place& from, int64_t side, float) {
        low = glm::min(low, from);
        high = glm::max(high, from + side);
    });
    if (low.x > high.x) low = high = Place(0); // nothing is there
    NanoGrid result;
    DensityGrid& grid = result.grid;
    Place first, size;
    for (;; result.voxelsOfCell *= 2) { // in cells, with a layer around
        const int64_t n = result.voxelsOfCell;
        for (int i = 0; i < 3; ++i) {
            first[i] = int64_t(std::floor(double(low[i]) / double(n))) - 1;
            size[i] = int64_t(std::ceil(double(high[i]) / double(n))) + 1 - first[i];
        }
        if (double(size.x) * double(size.y) * double(size.z) <= double(mostCells) ||
            size == Place(3))
            break;
    }
    const int64_t n = result.voxelsOfCell;
    const uint64_t cells = uint64_t(size.x) * uint64_t(size.y) * uint64_t(size.z);
    build::requireMemory(bytes.file(), cells * sizeof(float));
    grid.size = glm::uvec3(size);
    grid.values.assign(cells, 0);
    const float share = float(1.0 / (double(n) * double(n) * double(n)));
    tree.forEach([&](const Place& from, int64_t side, float value) {
        const Place begin = (from - first * n) / n, end = (from + (side - 1) - first * n) / n;
        for (int64_t z = begin.z; z <= end.z; ++z)
            for (int64_t y = begin.y; y <= end.y; ++y)
                for (int64_t x = begin.x; x <= end.x; ++x) {
                    // Cells and cubes have sides that are powers of two, so that the smaller one
                    // is within the larger.
                    const double voxels = std::pow(double(std::min(side, n)), 3);
                    grid.values[uint64_t(x + size.x * (y + size.y * z))] +=
                        value * share * float(voxels);
                }
    });
    const glm::dmat4 identity(1.0);
    const glm::dvec3 corner = double(n) * glm::dvec3(first) - 0.5;
    grid.setWorld(spaceOf(bytes) * glm::translate(identity, corner) *
                  glm::scale(identity, double(n) * glm::dvec3(size)));
    return result;
}

// --- The file ------------------------------------------------------------------------------------

std::string unpacked(const Bytes& packed, uint64_t size) {
    constexpr uint64_t kMostRatio = 1100; // zlib packs nothing to less than a 1032nd
    const auto length = packed.at<uint64_t>(0);
    const Bytes stream = packed.part(8, length);
    if (size > kMostRatio * length + kMostRatio)
        packed.fail("is damaged: a packed grid is too short");
    build::requireMemory(packed.file(), size);
    std::string bytes(size, '\0');
    uLongf unpackedSize = size;
    if (uncompress(reinterpret_cast<Bytef*>(bytes.data()), &unpackedSize,
                   reinterpret_cast<const Bytef*>(stream.text().data()), length) != Z_OK ||
        unpackedSize != size)
        packed.fail("is packed by zlib, and damaged");
    return bytes;
}

std::string_view upToZero(std::string_view text) {
    return text.substr(0, text.find('\0'));
}

std::string typeOf(uint32_t type) {
    constexpr const char* kTypes[] = {"", "", "double", "int16", "int32", "int64", "vectors"};
    return type < std::size(kTypes) && kTypes[type][0] ? kTypes[type]
                                                       : fmt::format("type {}", type);
}

/// place: of the version in the bytes, whose highest bits are the number of the format.
void requireFormat(const Bytes& bytes, uint64_t place) {
    constexpr uint32_t kFormat = 32;
    const uint32_t found = bytes.at<uint32_t>(place) >> 21;
    if (found != kFormat)
        bytes.fail(fmt::format("is of format {} of NanoVDB, expected {}", found, kFormat));
}

NanoGrid gridIn(const Bytes& bytes, uint64_t mostCells) {
    requireFormat(bytes, GridHeader::kVersion);
    const auto type = bytes.at<uint32_t>(GridHeader::kType);
    if (type != kFloats) bytes.fail(fmt::format("has a grid of {}, expected floats", typeOf(type)));
    return inCells(bytes, mostCells);
}

/// Files that are grids alone, as they are in memory.
std::optional<NanoGrid> amongRawGrids(const Bytes& file, std::string_view name,
                                      uint64_t mostCells) {
    for (uint64_t from = 0; from < file.size();) {
        const Bytes grid = file.part(from, file.at<uint64_t>(from + GridHeader::kSize));
        if (upToZero(grid.part(GridHeader::kName, GridHeader::kNameBytes).text()) == name)
            return gridIn(grid, mostCells);
        from += std::max(grid.size(), GridHeader::kBytes);
    }
    return std::nullopt;
}

std::optional<NanoGrid> inSegments(const Bytes& file, std::string_view name, uint64_t mostCells) {
    for (uint64_t from = 0; from < file.size();) {
        requireFormat(file, from + Segment::kVersion);
        const auto count = file.at<uint16_t>(from + Segment::kGridCount);
        const auto codec = Codec(file.at<uint16_t>(from + Segment::kCodec));
        uint64_t described = from + Segment::kBytes;
        struct Found {
            uint64_t size, sizeInFile;
            std::string_view name;
        };
        std::vector<Found> grids;
        for (uint16_t i = 0; i < count; ++i) {
            const Bytes text = file.part(described, Description::kBytes);
            const auto nameSize = text.at<uint32_t>(Description::kNameSize);
            grids.push_back(
                {text.at<uint64_t>(Description::kGridSize),
                 text.at<uint64_t>(Description::kSizeInFile),
                 upToZero(file.part(described + Description::kBytes, nameSize).text())});
            described += Description::kBytes + nameSize;
        }
        from = described;
        for (const Found& found : grids) {
            const Bytes packed = file.part(from, found.sizeInFile);
            from += found.sizeInFile;
            if (found.name != name) continue;
            if (codec == Codec::None) return gridIn(packed, mostCells);
            if (codec != Codec::Zip)
                file.fail("is packed by Blosc: expected a file that is not packed or packed by "
                          "zlib (nanovdb_convert -z)");
            const std::string bytes = unpacked(packed, found.size);
            return gridIn(Bytes(bytes, file.file()), mostCells);
        }
    }
    return std::nullopt;
}

} // namespace

std::optional<NanoGrid> readNanoGrid(std::string_view bytes, const std::string& file,
                                     std::string_view name, uint64_t mostCells) {
    const Bytes all(bytes, file);
    constexpr std::string_view kMagic = "NanoVDB"; // and a digit: 0, 1 for a grid, 2 for a file
    if (!bytes.starts_with(kMagic)) all.fail("is no NanoVDB file: expected to begin with NanoVDB");
    return all.at<char>(kMagic.size()) == '1' ? amongRawGrids(all, name, mostCells)
                                              : inSegments(all, name, mostCells);
}

} // namespace stromboli::pbrt
