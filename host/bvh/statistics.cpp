#include "host/bvh/statistics.hpp"

#include "host/bvh/node_record.hpp"

#include <algorithm>
#include <vector>

namespace stromboli {

namespace {

double halfArea(const bvh::GridBox& box) {
    const glm::dvec3 e = box.hi - box.lo;
    return e.x * e.y + e.y * e.z + e.z * e.x;
}

struct Visit {
    uint32_t record, depth;
    double area;
};

class Measuring {
  public:
    explicit Measuring(const WideLayout& layout) : layout_(layout) {
        s_.recordBytes = layout.records.size() * sizeof(Record);
        s_.primitives = layout.primitiveOrder.size();
    }

    BvhStatistics run() {
        pending_.push_back({0, 0, 0});
        while (!pending_.empty()) {
            const Visit next = pending_.back();
            pending_.pop_back();
            s_.depth = std::max(s_.depth, next.depth);
            area_ += next.area;
            const Record& r = layout_.records.at(next.record);
            if (isNode(r))
                visitNode(asNode(r), next);
            else if (isPlacement(r))
                ++s_.placements;
            else
                visitLeaf(asLeaf(r));
        }
        s_.expectedVisits = 1 + (rootArea_ > 0 ? area_ / rootArea_ : 0);
        return s_;
    }

  private:
    void visitNode(const gpu::NodeRecord& node, const Visit& visit) {
        ++s_.nodes;
        uint32_t children = 0;
        bvh::GridBox all;
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot) {
            const bvh::GridBox box = bvh::childBox(node, slot);
            if (box.empty()) continue;
            ++children;
            all.extend(box);
            pending_.push_back({bvh::firstChild(node) + slot, visit.depth + 1, halfArea(box)});
        }
        ++s_.nodesOfSize[children];
        if (visit.record == 0 && children > 0) rootArea_ = halfArea(all);
    }

    void visitLeaf(const gpu::LeafRecord& leaf) {
        ++s_.leaves;
        ++s_.leavesOfSize[leaf.p3 != leaf.p2 ? 2 : 1];
    }

    const WideLayout& layout_;
    BvhStatistics s_;
    std::vector<Visit> pending_;
    double area_ = 0, rootArea_ = 0;
};

} // namespace

double BvhStatistics::childrenPerNode() const {
    double children = 0;
    for (size_t n = 0; n < nodesOfSize.size(); ++n)
        children += double(n) * nodesOfSize[n];
    return children / nodes;
}

double BvhStatistics::primitivesPerLeaf() const {
    return leaves > 0 ? double(primitives) / leaves : 0;
}

double BvhStatistics::bytesPerPrimitive() const {
    return primitives > 0 ? double(recordBytes) / double(primitives) + sizeof(gpu::Primitive) : 0;
}

BvhStatistics measure(const WideLayout& layout) {
    return Measuring(layout).run();
}

} // namespace stromboli
