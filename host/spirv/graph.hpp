#pragma once

#include "host/spirv/module.hpp"

#include <cstdint>
#include <vector>

namespace stromboli::spirv {

/// A function's blocks by label, and who goes to each.
class Graph {
  public:
    Graph(Module& module, Function& function)
        : module_(module), function_(function), indexOf_(module.bound) {
        for (size_t b = 0; b < function.blocks.size(); ++b)
            indexOf_[function.blocks[b].label] = b;
    }

    size_t indexOf(uint32_t label) const { return indexOf_[label]; }
    Block& block(uint32_t label) { return function_.blocks[indexOf(label)]; }

    /// Calls `visit` with each label that a block goes on to; a label that is named twice comes
    /// twice.
    template <class Visit>
    void forEachSuccessor(const Block& block, Visit visit) const {
        const Instruction& end = block.body.back();
        const auto operands = module_.operands(end);
        if (end.op == OpBranch) visit(operands[0]);
        if (end.op == OpBranchConditional) {
            visit(operands[1]);
            visit(operands[2]);
        }
        if (end.op == OpSwitch)
            for (size_t k = 1; k < operands.size(); k += 2)
                visit(operands[k]);
    }

    /// By index of a block, the labels of those that go on to it, each once.
    std::vector<std::vector<uint32_t>> predecessors() const {
        std::vector<std::vector<uint32_t>> from(function_.blocks.size());
        for (const Block& b : function_.blocks)
            forEachSuccessor(b, [&](uint32_t label) {
                std::vector<uint32_t>& labels = from[indexOf(label)];
                if (labels.empty() || labels.back() != b.label) labels.push_back(b.label);
            });
        return from;
    }

  private:
    Module& module_;
    Function& function_;
    std::vector<size_t> indexOf_; ///< by label
};

/// The instruction before a block's last one that names its merge block; null: there is none.
inline const Instruction* mergeOf(const Block& block) {
    if (block.body.size() < 2) return nullptr;
    const Instruction& i = block.body[block.body.size() - 2];
    return i.op == OpSelectionMerge || i.op == OpLoopMerge ? &i : nullptr;
}

inline void dropMerge(Block& block) {
    block.body.erase(block.body.end() - 2);
}

inline void goTo(Module& module, Block& block, uint32_t label) {
    block.body.back() = module.make(OpBranch, 0, 0, {&label, 1});
}

/// Which selection, switch or loop each block is directly in.
class Constructs {
  public:
    static constexpr uint32_t kNone = 0;

    Constructs(const Module& module, const Graph& graph, const Function& function)
        : module_(module), graph_(graph), function_(function), header_(function.blocks.size()),
          isKnown_(function.blocks.size()) {
        enter(function.blocks[0].label, kNone);
        while (!open_.empty()) {
            const uint32_t label = open_.back();
            open_.pop_back();
            visit(function_.blocks[graph_.indexOf(label)]);
        }
    }

    /// The label of its header; kNone: there is none, or the block cannot be reached.
    uint32_t headerOf(uint32_t label) const { return header_[graph_.indexOf(label)]; }

  private:
    void enter(uint32_t label, uint32_t header) {
        const size_t b = graph_.indexOf(label);
        if (isKnown_[b]) return;
        isKnown_[b] = true;
        header_[b] = header;
        open_.push_back(label);
    }

    /// Merge blocks, and where loops go on, are entered with their headers, before anything that
    /// jumps there.
    void visit(const Block& block) {
        uint32_t header = headerOf(block.label);
        if (const Instruction* merge = mergeOf(block)) {
            enter(module_.operands(*merge)[0], header);
            header = block.label;
            if (merge->op == OpLoopMerge) enter(module_.operands(*merge)[1], header);
        }
        graph_.forEachSuccessor(block, [&](uint32_t label) { enter(label, header); });
    }

    const Module& module_;
    const Graph& graph_;
    const Function& function_;
    std::vector<uint32_t> header_;
    std::vector<bool> isKnown_;
    std::vector<uint32_t> open_;
};

} // namespace stromboli::spirv
