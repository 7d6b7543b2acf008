#include "tests/bvh/sweep_builder.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

namespace stromboli::test {

namespace {

class SweepBuilder {
  public:
    explicit SweepBuilder(std::span<const Bounds> primitives) : primitives_(primitives) {}

    /// Area of the inner nodes of the subtree over a run of primitives.
    double cost(std::span<uint32_t> run) const {
        if (run.size() == 1) return 0;
        const double area = boundsOf(run).halfArea();
        const Split best = bestSplit(run);
        sortBy(best.axis, run);
        return area + cost(run.first(best.leftCount)) + cost(run.subspan(best.leftCount));
    }

  private:
    struct Split {
        double cost = std::numeric_limits<double>::infinity();
        int axis = 0;
        size_t leftCount = 1;
    };

    Bounds boundsOf(std::span<const uint32_t> run) const {
        Bounds b;
        for (const uint32_t i : run)
            b.extend(primitives_[i]);
        return b;
    }

    void sortBy(int axis, std::span<uint32_t> run) const {
        const auto key = [&](uint32_t i) {
            return std::pair(primitives_[i].lo[axis] + primitives_[i].hi[axis], i);
        };
        std::sort(run.begin(), run.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
    }

    Split bestSplit(std::span<uint32_t> run) const {
        Split best;
        std::vector<double> rightArea(run.size());
        for (int axis = 0; axis < 3; ++axis) {
            sortBy(axis, run);
            Bounds right, left;
            for (size_t i = run.size() - 1; i > 0; --i) {
                right.extend(primitives_[run[i]]);
                rightArea[i] = right.halfArea();
            }
            for (size_t i = 1; i < run.size(); ++i) {
                left.extend(primitives_[run[i - 1]]);
                const double cost =
                    left.halfArea() * double(i) + rightArea[i] * double(run.size() - i);
                if (cost < best.cost) best = {cost, axis, i};
            }
        }
        return best;
    }

    std::span<const Bounds> primitives_;
};

} // namespace

double sweepInnerArea(std::span<const Bounds> boxes) {
    std::vector<uint32_t> run(boxes.size());
    std::iota(run.begin(), run.end(), 0u);
    Bounds all;
    for (const Bounds& b : boxes)
        all.extend(b);
    return SweepBuilder(boxes).cost(run) / double(all.halfArea());
}

} // namespace stromboli::test
