#include "host/bvh/node_record.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace stromboli::bvh {

// --- Boxes on a node's grid ----------------------------------------------------------------------

namespace {

constexpr int kExponentBias = 127;
constexpr int kLeastExponent = -90;
constexpr double kLastPlane = 255;

/// In cells. A position on the grid is a difference of two doubles, off by half an ulp of at
/// most 256 cells, that is 2^-45; 2^-40 more than the margin makes up for it.
constexpr double kMargin = gpu::BOX_MARGIN + 0x1p-40;

constexpr uint32_t kOriginMask = 0xFFFFFF00u;

/// The greatest float not above x whose last 8 bits are 0.
float originNotAbove(double x) {
    float nearest = float(x);
    if (double(nearest) > x) nearest = std::nextafter(nearest, -std::numeric_limits<float>::max());
    const uint32_t bits = std::bit_cast<uint32_t>(nearest);
    // Clearing bits moves it towards 0; below 0 it has to go away from 0.
    const bool awayFromZero = nearest < 0 && (bits & ~kOriginMask) != 0;
    return std::bit_cast<float>((bits & kOriginMask) + (awayFromZero ? ~kOriginMask + 1 : 0));
}

/// 2^n, n being far from the ends of double's range.
double powerOfTwo(int n) {
    return std::bit_cast<double>(uint64_t(n + 1023) << 52);
}

/// In cells from the grid's origin.
double position(const AxisGrid& grid, double x) {
    return (x - double(grid.origin)) * powerOfTwo(kExponentBias - int(grid.exponent));
}

} // namespace

double AxisGrid::cell() const {
    return powerOfTwo(int(exponent) - kExponentBias);
}

uint32_t AxisGrid::word() const {
    return std::bit_cast<uint32_t>(origin) | exponent;
}

AxisGrid AxisGrid::fromWord(uint32_t word) {
    return {std::bit_cast<float>(word & kOriginMask), word & ~kOriginMask};
}

AxisGrid gridOver(double low, double high) {
    const double extent = high - low;
    int exponent = kLeastExponent;
    if (extent > 0) exponent = std::max(exponent, std::ilogb(extent / kLastPlane));
    for (;; ++exponent) {
        const double cell = powerOfTwo(exponent);
        // Twice the margin, so that rounding leaves one of them. Far from 0 origins
        // lie farther apart than the cells: it is then well below, and the cells have to be larger.
        const AxisGrid grid{originNotAbove(low - 2 * kMargin * cell),
                            uint32_t(exponent + kExponentBias)};
        if (position(grid, low) >= kMargin && position(grid, high) + kMargin <= kLastPlane)
            return grid;
    }
}

uint32_t planeBelow(const AxisGrid& grid, double low) {
    return uint32_t(std::floor(position(grid, low) - kMargin));
}

uint32_t planeAbove(const AxisGrid& grid, double high) {
    return uint32_t(std::ceil(position(grid, high) + kMargin));
}

// --- Node records --------------------------------------------------------------------------------

namespace {

constexpr double kPaddingOfScene = 0x1p-32; // of its largest coordinate
constexpr double kPaddingOfChild = 0x1p-21; // of its largest extent

struct Interval {
    double low, high;
};

Interval padded(const Bounds& box, int axis, double padding) {
    const glm::dvec3 extent = glm::dvec3(box.hi) - glm::dvec3(box.lo);
    const double largest = std::max(extent.x, std::max(extent.y, extent.z));
    const double pad = padding + kPaddingOfChild * largest;
    return {double(box.lo[axis]) - pad, double(box.hi[axis]) + pad};
}

/// The planes of an axis: the low and then the high ones, four to a word.
struct AxisPlanes {
    uint32_t gridWord = 0;
    uint32_t low[2] = {0, 0}, high[2] = {0, 0};
};

AxisPlanes packAxis(const ChildBoxes& children, int axis, double padding) {
    std::optional<Interval> all;
    for (const auto& child : children)
        if (child) {
            const Interval i = padded(*child, axis, padding);
            all = all ? Interval{std::min(all->low, i.low), std::max(all->high, i.high)} : i;
        }
    const AxisGrid grid = all ? gridOver(all->low, all->high) : AxisGrid{};
    AxisPlanes planes;
    planes.gridWord = grid.word();
    for (size_t slot = 0; slot < children.size(); ++slot) {
        uint32_t low = 255, high = 0; // absent
        if (children[slot]) {
            const Interval i = padded(*children[slot], axis, padding);
            low = planeBelow(grid, i.low);
            high = planeAbove(grid, i.high);
        }
        planes.low[slot / 4] |= low << (8 * (slot % 4));
        planes.high[slot / 4] |= high << (8 * (slot % 4));
    }
    return planes;
}

} // namespace

double boxPadding(const Bounds& scene) {
    double largest = 0;
    if (!scene.empty())
        for (int axis = 0; axis < 3; ++axis)
            largest = std::max(largest, double(std::max(-scene.lo[axis], scene.hi[axis])));
    return kPaddingOfScene * largest;
}

gpu::NodeRecord packNode(const ChildBoxes& children, uint32_t firstChild, double padding) {
    const AxisPlanes x = packAxis(children, 0, padding), y = packAxis(children, 1, padding),
                     z = packAxis(children, 2, padding);
    return {x.gridWord, y.gridWord, z.gridWord, gpu::RECORD_IS_NODE | firstChild,
            x.low[0],   x.low[1],   x.high[0],  x.high[1],
            y.low[0],   y.low[1],   y.high[0],  y.high[1],
            z.low[0],   z.low[1],   z.high[0],  z.high[1]};
}

GridBox childBox(const gpu::NodeRecord& node, uint32_t slot) {
    const uint32_t words[3][5] = {
        {node.originAndExponentX, node.lowX0, node.lowX1, node.highX0, node.highX1},
        {node.originAndExponentY, node.lowY0, node.lowY1, node.highY0, node.highY1},
        {node.originAndExponentZ, node.lowZ0, node.lowZ1, node.highZ0, node.highZ1}};
    GridBox box;
    for (int axis = 0; axis < 3; ++axis) {
        const AxisGrid grid = AxisGrid::fromWord(words[axis][0]);
        const auto plane = [&](size_t word) {
            return double(words[axis][word + slot / 4] >> (8 * (slot % 4)) & 255u);
        };
        box.lo[axis] = double(grid.origin) + plane(1) * grid.cell();
        box.hi[axis] = double(grid.origin) + plane(3) * grid.cell();
    }
    return box;
}

uint32_t firstChild(const gpu::NodeRecord& node) {
    return node.firstChild & gpu::RECORD_INDEX_MASK;
}

// --- Places of records ---------------------------------------------------------------------------

namespace {

constexpr uint32_t kChildren = gpu::WIDE_CHILDREN;

/// Marks among the records of the window; bit 0 of the first word is the window's first record.
class Marks {
  public:
    static constexpr uint32_t kRecords = 256;

    /// The eight marks from record i on.
    uint32_t from(uint32_t i) const {
        const uint32_t word = i / 64, bit = i % 64;
        uint64_t marks = words_[word] >> bit;
        if (bit > 64 - kChildren && word + 1 < words_.size())
            marks |= words_[word + 1] << (64 - bit);
        return uint32_t(marks & 255u);
    }
    void set(uint32_t i, uint32_t slots) {
        const uint32_t word = i / 64, bit = i % 64;
        words_[word] |= uint64_t(slots) << bit;
        if (bit > 64 - kChildren && word + 1 < words_.size())
            words_[word + 1] |= uint64_t(slots) >> (64 - bit);
    }
    void advance() {
        for (size_t word = 0; word + 1 < words_.size(); ++word)
            words_[word] = words_[word] >> kChildren | words_[word + 1] << (64 - kChildren);
        words_.back() >>= kChildren;
    }

  private:
    std::array<uint64_t, kRecords / 64> words_{};
};

/// The last records; nothing is put before them any more.
class Window {
  public:
    Window() { used_.set(0, 1), nodes_.set(0, 1); } // the root

    /// The least first record at which the node's children fit; moves the window if there is none.
    uint32_t place(const WideNode& node) {
        const uint32_t used = node.nodes | node.leaves, absent = used ^ 255u;
        for (;; advance())
            for (uint32_t i = 0; i + kChildren <= Marks::kRecords; ++i) {
                const bool fits = (used_.from(i) & used) == 0 && (nodes_.from(i) & absent) == 0 &&
                                  (absent_.from(i) & node.nodes) == 0;
                if (!fits) continue;
                used_.set(i, used), nodes_.set(i, node.nodes), absent_.set(i, absent);
                return start_ + i;
            }
    }

  private:
    void advance() {
        used_.advance(), nodes_.advance(), absent_.advance();
        start_ += kChildren;
    }

    uint32_t start_ = 0;
    Marks used_, nodes_;
    Marks absent_; ///< absent slots of some node
};

} // namespace

RecordPacking packRecords(std::span<const WideNode> nodes) {
    struct Pending {
        uint32_t record, depth;
    };
    RecordPacking packing;
    packing.places.reserve(nodes.size());
    Window window;
    std::vector<Pending> pending{{0, 0}};
    for (const WideNode& node : nodes) {
        const Pending next = pending.back();
        pending.pop_back();
        const uint32_t firstChild = window.place(node);
        packing.places.push_back({next.record, firstChild});
        packing.records = std::max(packing.records, firstChild + kChildren);
        packing.depth = std::max(packing.depth, next.depth);
        for (uint32_t slot = kChildren; slot-- > 0;)
            if (node.isNode(slot)) pending.push_back({firstChild + slot, next.depth + 1});
    }
    return packing;
}

} // namespace stromboli::bvh
