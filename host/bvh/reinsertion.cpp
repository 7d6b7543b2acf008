#include "host/bvh/reinsertion.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

namespace stromboli::bvh {

// --- A tree whose subtrees can move --------------------------------------------------------------

LinkedTree::LinkedTree(const BinaryTree& tree) : nodes_(tree.nodes.size()) {
    for (uint32_t i = 0; i < nodes_.size(); ++i) {
        const BinaryNode& from = tree.nodes[i];
        Node& to = nodes_[i];
        const glm::vec3 &lo = from.bounds.lo, &hi = from.bounds.hi;
        to.box = {Float4{lo.x, lo.y, lo.z, 0}, Float4{hi.x, hi.y, hi.z, 0}};
        to.area = to.box.halfArea();
        to.left = from.isLeaf() ? kNone : from.left;
        to.right = from.isLeaf() ? kNone : from.right;
        if (i == 0) to.parent = kNone;
        if (!from.isLeaf()) nodes_[from.left].parent = nodes_[from.right].parent = i;
    }
}

uint32_t LinkedTree::sibling(uint32_t node) const {
    const Node& parent = nodes_[nodes_[node].parent];
    return parent.left == node ? parent.right : parent.left;
}

double LinkedTree::innerArea() const {
    double sum = 0;
    for (const Node& node : nodes_)
        if (!node.isLeaf()) sum += node.area;
    return sum;
}

bool LinkedTree::canMove(uint32_t subtree, uint32_t beside) const {
    const uint32_t parent = nodes_[subtree].parent;
    if (parent == kNone || nodes_[parent].parent == kNone) return false;
    if (beside == 0 || beside == parent || beside == sibling(subtree)) return false;
    uint32_t ancestor = beside;
    while (ancestor != kNone && ancestor != subtree)
        ancestor = nodes_[ancestor].parent;
    return ancestor == kNone;
}

double LinkedTree::move(uint32_t subtree, uint32_t beside) {
    // The parent goes along and becomes the new common parent.
    const uint32_t parent = nodes_[subtree].parent, grandparent = nodes_[parent].parent;
    replaceChild(grandparent, parent, sibling(subtree));
    double grown = refitUpwards(grandparent);
    const uint32_t newGrandparent = nodes_[beside].parent;
    replaceChild(newGrandparent, beside, parent);
    nodes_[parent].left = beside;
    nodes_[parent].right = subtree;
    nodes_[beside].parent = nodes_[subtree].parent = parent;
    grown += refitNode(parent);
    return grown + refitUpwards(newGrandparent);
}

BinaryTree LinkedTree::depthFirst(const BinaryTree& original) const {
    struct Pending {
        uint32_t node;
        uint32_t parent; ///< whose right child it is, or kNone
        uint32_t depth;
    };
    BinaryTree tree;
    tree.nodes.reserve(nodes_.size());
    std::vector<Pending> pending{{0, kNone, 0}};
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const Node& from = nodes_[next.node];
        const uint32_t index = uint32_t(tree.nodes.size());
        if (next.parent != kNone) tree.nodes[next.parent].right = index;
        tree.depth = std::max(tree.depth, next.depth);
        if (from.isLeaf()) {
            tree.nodes.push_back(original.nodes[next.node]);
            continue;
        }
        tree.nodes.push_back({from.box.bounds(), index + 1, 0});
        pending.push_back({from.right, index, next.depth + 1});
        pending.push_back({from.left, kNone, next.depth + 1});
    }
    return tree;
}

void LinkedTree::replaceChild(uint32_t parent, uint32_t child, uint32_t by) {
    Node& node = nodes_[parent];
    (node.left == child ? node.left : node.right) = by;
    nodes_[by].parent = parent;
}

double LinkedTree::refitNode(uint32_t index) {
    Node& node = nodes_[index];
    const float before = node.area;
    node.box = nodes_[node.left].box;
    node.box.extend(nodes_[node.right].box);
    node.area = node.box.halfArea();
    return double(node.area) - double(before);
}

double LinkedTree::refitUpwards(uint32_t node) {
    double grown = 0;
    for (; node != kNone; node = nodes_[node].parent)
        grown += refitNode(node);
    return grown;
}

// --- Reinsertion ---------------------------------------------------------------------------------

namespace {

constexpr uint32_t kNone = LinkedTree::kNone;

// How much work it is worth; docs/results.md has the measurements. Only the largest boxes matter:
// an eighth of the nodes, in rounds until one gains less than a hundredth.
constexpr size_t kCandidateShare = 8, kLeastCandidates = 1u << 13;
constexpr uint32_t kMostRounds = 10;
constexpr double kLeastGain = 0.01;
/// Nodes a search looks into; reached only where very many boxes overlap.
constexpr uint32_t kMostVisits = 1024;

/// Where a subtree is to go.
struct Move {
    double gain = 0; ///< by how much the inner nodes' areas shrink together
    uint32_t subtree = 0, beside = kNone;
};

/// Finds the best place for a subtree, by branch and bound over the whole tree.
class Search {
  public:
    explicit Search(const LinkedTree& tree) : tree_(tree) {}

    Move bestMove(uint32_t subtree) {
        const LinkedTree::Node& moved = tree_[subtree];
        if (moved.parent == kNone || tree_[moved.parent].parent == kNone) return {};
        box_ = moved.box;
        area_ = moved.area;
        best_ = {0, subtree, kNone};
        visitsLeft_ = kMostVisits;
        // The path up from the old place: `saved` is by how much the areas below `ancestor`
        // shrink without the subtree, `without` what is left of the box on the path there.
        uint32_t child = moved.parent, ancestor = tree_[child].parent;
        Box4 without = tree_[tree_.sibling(subtree)].box;
        double saved = tree_[child].area;
        visitSubtree(tree_.sibling(subtree), saved, true);
        while (ancestor != kNone) {
            const uint32_t sibling = tree_.sibling(child);
            visitSubtree(sibling, saved, false);
            without.extend(tree_[sibling].box);
            saved += double(tree_[ancestor].area) - double(without.halfArea());
            child = ancestor;
            ancestor = tree_[ancestor].parent;
        }
        return best_;
    }

  private:
    struct Branch {
        double saved; ///< by the way down to the children of ...
        uint32_t node;
    };

    void visitSubtree(uint32_t root, double saved, bool isOldSibling) {
        enter(root, saved, !isOldSibling);
        while (!branches_.empty()) {
            const Branch branch = branches_.back();
            branches_.pop_back();
            if (branch.saved - area_ <= best_.gain || visitsLeft_ == 0) continue;
            --visitsLeft_;
            const LinkedTree::Node& node = tree_[branch.node];
            enter(node.left, branch.saved, true);
            enter(node.right, branch.saved, true);
        }
    }

    /// Considers the place beside the node, and leaves those below it for later.
    void enter(uint32_t index, double saved, bool beside) {
        const LinkedTree::Node& node = tree_[index];
        Box4 joint = node.box;
        joint.extend(box_);
        const double jointArea = joint.halfArea();
        if (beside && saved - jointArea > best_.gain) {
            best_.gain = saved - jointArea;
            best_.beside = index;
        }
        const double savedBelow = saved - (jointArea - double(node.area));
        if (!node.isLeaf() && savedBelow - area_ > best_.gain)
            branches_.push_back({savedBelow, index});
    }

    const LinkedTree& tree_;
    Box4 box_;
    double area_ = 0;
    Move best_;
    uint32_t visitsLeft_ = 0;
    std::vector<Branch> branches_;
};

/// The subtrees with the largest boxes, in no particular order.
std::vector<uint32_t> largestNodes(const LinkedTree& tree) {
    struct Candidate {
        float area;
        uint32_t node;
    };
    std::vector<Candidate> nodes(tree.size());
    for (uint32_t i = 0; i < tree.size(); ++i)
        nodes[i] = {tree[i].area, i};
    const size_t count =
        std::min(nodes.size(), std::max(nodes.size() / kCandidateShare, kLeastCandidates));
    std::nth_element(nodes.begin(), nodes.begin() + std::ptrdiff_t(count), nodes.end(),
                     [](const Candidate& a, const Candidate& b) {
                         return std::tuple(-a.area, a.node) < std::tuple(-b.area, b.node);
                     });
    std::vector<uint32_t> largest(count);
    for (size_t i = 0; i < count; ++i)
        largest[i] = nodes[i].node;
    return largest;
}

/// The moves that gain something, best first.
std::vector<Move> findMoves(const LinkedTree& tree, const std::vector<uint32_t>& subtrees) {
    std::vector<Move> moves(subtrees.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, subtrees.size(), 64), [&](const auto& range) {
        Search search(tree);
        for (size_t i = range.begin(); i != range.end(); ++i)
            moves[i] = search.bestMove(subtrees[i]);
    });
    std::erase_if(moves, [](const Move& m) { return m.beside == kNone; });
    tbb::parallel_sort(moves, [](const Move& a, const Move& b) {
        return std::tuple(-a.gain, a.subtree) < std::tuple(-b.gain, b.subtree);
    });
    return moves;
}

/// One after the other; a move that earlier ones have turned into a loss is undone. Returns the
/// area gained.
double carryOut(LinkedTree& tree, const std::vector<Move>& moves) {
    double gained = 0;
    for (const Move& m : moves) {
        if (!tree.canMove(m.subtree, m.beside)) continue;
        const uint32_t oldSibling = tree.sibling(m.subtree);
        const double grown = tree.move(m.subtree, m.beside);
        if (grown < 0)
            gained -= grown;
        else
            tree.move(m.subtree, oldSibling);
    }
    return gained;
}

} // namespace

void reinsertSubtrees(BinaryTree& tree, uint32_t depthCap) {
    if (tree.nodes.empty()) return;
    LinkedTree linked(tree);
    double area = linked.innerArea();
    for (uint32_t round = 0; round < kMostRounds; ++round) {
        const std::vector<uint32_t> candidates = largestNodes(linked);
        const double gained = carryOut(linked, findMoves(linked, candidates));
        area -= gained;
        if (gained <= kLeastGain * area) break;
    }
    BinaryTree improved = linked.depthFirst(tree);
    if (improved.depth <= depthCap) tree = std::move(improved);
}

} // namespace stromboli::bvh
