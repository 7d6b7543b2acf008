#include "host/bvh/record_packing.hpp"

#include <algorithm>
#include <array>

namespace stromboli::bvh {

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
