#include "host/spirv/graph.hpp"

#include <algorithm>
#include <optional>

namespace stromboli::spirv {
namespace {

// A function that returns early is inlined as a switch with one case, which its returns leave by
// jumps to the switch's merge block. Mesa makes a loop of a switch that is left from within
// selections, and takes several rounds of all its passes to get rid of that. Here
//
//     switch { if (c) { A; leave } B; leave }    becomes    if (c) { A } else { B }
//
// one early exit after the other.

/// One function, as it is before a switch changes.
class Switches {
  public:
    Switches(Module& module, Function& function)
        : module_(module), function_(function), graph_(module, function),
          predecessors_(graph_.predecessors()), constructs_(module, graph_, function) {}

    bool dissolveOne() {
        for (Block& block : function_.blocks) {
            const Instruction* merge = mergeOf(block);
            if (merge == nullptr || block.body.back().op != OpSwitch ||
                block.body.back().count != 2)
                continue;
            const uint32_t target = module_.operands(*merge)[0];
            const std::vector<uint32_t>& exits = predecessors_[graph_.indexOf(target)];
            if (isLeftAtItsEnd(block.label, exits)) {
                const uint32_t only = module_.operands(block.body.back())[1];
                dropMerge(block);
                goTo(module_, block, only);
                return true;
            }
            if (!beginsWithPhi(target) && joinEarlyExit(target, exits)) return true;
        }
        return false;
    }

  private:
    bool beginsWithPhi(uint32_t label) { return graph_.block(label).body.front().op == OpPhi; }

    uint32_t mergeOfHeader(uint32_t header) {
        return module_.operands(*mergeOf(graph_.block(header)))[0];
    }

    bool isLeftAtItsEnd(uint32_t header, const std::vector<uint32_t>& exits) {
        if (exits.size() != 1) return exits.empty();
        return exits[0] == header || (constructs_.headerOf(exits[0]) == header &&
                                      graph_.block(exits[0]).body.back().op == OpBranch);
    }

    /// Whether a block is another one, or only goes there.
    bool leadsTo(uint32_t label, uint32_t target) {
        for (size_t steps = 0; steps < function_.blocks.size() && label != target; ++steps) {
            const Block& block = graph_.block(label);
            if (block.body.size() != 1 || block.body[0].op != OpBranch) return false;
            label = module_.operands(block.body[0])[0];
        }
        return label == target;
    }

    /// A block that leaves the switch, and where it goes: to the switch's merge block, or to one
    /// that only goes there.
    struct End {
        uint32_t block = 0, to = 0;
    };
    /// How the sequence that begins with a block leaves the switch, if it does; selections,
    /// switches and loops in it are stepped over.
    std::optional<End> endOf(uint32_t label, uint32_t target) {
        for (size_t steps = 0; steps < function_.blocks.size(); ++steps) {
            const Block& block = graph_.block(label);
            const Instruction* merge = mergeOf(block);
            if (merge == nullptr && block.body.back().op != OpBranch) return {};
            const uint32_t next =
                module_.operands(merge != nullptr ? *merge : block.body.back())[0];
            if (merge == nullptr && leadsTo(next, target)) return End{label, next};
            if (constructs_.headerOf(next) != constructs_.headerOf(label) ||
                predecessors_[graph_.indexOf(next)].empty())
                return {};
            label = next;
        }
        return {};
    }

    /// Whether a block is directly in a selection of two ways, inside the switch, and jumps out of
    /// the switch.
    bool isEarlyExit(uint32_t exit, uint32_t target) {
        const uint32_t header = constructs_.headerOf(exit);
        if (header == Constructs::kNone || mergeOfHeader(header) == target) return false;
        const Block& block = graph_.block(header);
        return mergeOf(block)->op == OpSelectionMerge &&
               block.body.back().op == OpBranchConditional &&
               graph_.block(exit).body.back().op == OpBranch;
    }

    /// The exit beside an early one: of what follows its selection, or, if both ways of that leave
    /// the switch, of the other way.
    std::optional<End> endBeside(uint32_t exit, uint32_t target,
                                 const std::vector<uint32_t>& exits) {
        if (!isEarlyExit(exit, target)) return {};
        const uint32_t header = constructs_.headerOf(exit), merge = mergeOfHeader(header);
        const size_t others = predecessors_[graph_.indexOf(merge)].size();
        if (beginsWithPhi(merge)) return {};
        if (others == 1) return endOf(merge, target);
        if (others == 0)
            for (const uint32_t other : exits)
                if (other != exit && isEarlyExit(other, target) &&
                    constructs_.headerOf(other) == header)
                    return End{other, target};
        return {};
    }

    /// A selection that leaves the switch by one of its branches itself gets a block that does.
    bool splitBranch(uint32_t exit, uint32_t target) {
        Block& block = graph_.block(exit);
        const Instruction* merge = mergeOf(block);
        const Instruction end = block.body.back();
        if (merge == nullptr || merge->op != OpSelectionMerge || end.op != OpBranchConditional ||
            module_.operands(*merge)[0] == target)
            return false;
        const uint32_t leaving = module_.newNumber();
        std::vector<uint32_t> operands(module_.operands(end).begin(), module_.operands(end).end());
        std::replace(operands.begin() + 1, operands.begin() + 3, target, leaving);
        block.body.back() = module_.make(OpBranchConditional, 0, 0, operands);
        Block left{.label = leaving};
        left.body.push_back(module_.make(OpBranch, 0, 0, {&target, 1}));
        function_.blocks.insert(function_.blocks.begin() + std::ptrdiff_t(graph_.indexOf(exit)) + 1,
                                std::move(left));
        return true;
    }

    /// Has an early exit and the one beside it meet in a block where their selection ends, and what
    /// follows the selection become its other way.
    bool joinEarlyExit(uint32_t target, const std::vector<uint32_t>& exits) {
        for (const uint32_t exit : exits)
            if (splitBranch(exit, target)) return true;
        for (const uint32_t exit : exits)
            if (const std::optional<End> end = endBeside(exit, target, exits)) {
                join(constructs_.headerOf(exit), exit, *end);
                return true;
            }
        return false;
    }

    void join(uint32_t header, uint32_t exit, End end) {
        const uint32_t joined = module_.newNumber();
        goTo(module_, graph_.block(exit), joined);
        goTo(module_, graph_.block(end.block), joined);
        Instruction& merge = graph_.block(header).body[graph_.block(header).body.size() - 2];
        const uint32_t operands[] = {joined, module_.operands(merge)[1]};
        merge = module_.make(OpSelectionMerge, 0, 0, operands);
        Block block{.label = joined};
        block.body.push_back(module_.make(OpBranch, 0, 0, {&end.to, 1}));
        const size_t last = std::max(graph_.indexOf(exit), graph_.indexOf(end.block));
        function_.blocks.insert(function_.blocks.begin() + std::ptrdiff_t(last) + 1,
                                std::move(block));
    }

    Module& module_;
    Function& function_;
    Graph graph_;
    std::vector<std::vector<uint32_t>> predecessors_;
    Constructs constructs_;
};

} // namespace

bool dissolveSwitches(Module& module) {
    bool changed = false;
    for (Function& f : module.functions)
        while (!f.blocks.empty() && Switches(module, f).dissolveOne())
            changed = true;
    return changed;
}

} // namespace stromboli::spirv
