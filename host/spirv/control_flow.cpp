#include "host/spirv/graph.hpp"

#include <algorithm>
#include <unordered_set>

namespace stromboli::spirv {
namespace {

/// Values of constants that decide branches.
class Decisions {
  public:
    explicit Decisions(const Module& module) {
        for (const Instruction& i : module.globals) {
            if (i.op == OpConstantTrue) values_[i.result] = 1;
            if (i.op == OpConstantFalse) values_[i.result] = 0;
            if (i.op == OpConstant && i.count == 1) values_[i.result] = module.operands(i)[0];
        }
    }
    std::optional<uint32_t> valueOf(uint32_t number) const {
        const auto found = values_.find(number);
        return found == values_.end() ? std::nullopt : std::optional(found->second);
    }

  private:
    std::unordered_map<uint32_t, uint32_t> values_;
};

/// Whether a jump back is all that keeps a loop, and the loop can do without being one: nothing
/// leaves it or goes on from within other constructs.
bool isLastOfLoop(Module& module, const Graph& graph,
                  const std::vector<std::vector<uint32_t>>& predecessors, const Block& header) {
    const auto operands = module.operands(*mergeOf(header));
    return predecessors[graph.indexOf(operands[0])].size() <= 1 &&
           predecessors[graph.indexOf(operands[1])].size() <= 1;
}

/// A decided `if` becomes a jump. A jump back that is never taken stays where the loop must stay
/// one. A decided `switch` keeps its merge block, because blocks deep inside it may leave it by a
/// jump there, which only a switch or a loop allows; it loses the other cases.
bool decideBranch(Module& module, const Decisions& decisions, Graph& graph,
                  const std::vector<std::vector<uint32_t>>& predecessors, Block& block) {
    const Instruction end = block.body.back();
    const auto operands = module.operands(end);
    if (end.op == OpBranchConditional) {
        const auto condition = decisions.valueOf(operands[0]);
        if (!condition && operands[1] != operands[2]) return false;
        const uint32_t target = condition.value_or(1) != 0 ? operands[1] : operands[2];
        const uint32_t other = target == operands[1] ? operands[2] : operands[1];
        Block& header = graph.block(other);
        const Instruction* loop = mergeOf(header);
        if (other != target && loop != nullptr && loop->op == OpLoopMerge &&
            graph.indexOf(other) <= graph.indexOf(block.label)) {
            if (!isLastOfLoop(module, graph, predecessors, header)) return false;
            dropMerge(header);
        }
        const Instruction* merge = mergeOf(block);
        if (merge != nullptr && merge->op == OpSelectionMerge) dropMerge(block);
        goTo(module, block, target);
        return true;
    }
    if (end.op == OpSwitch && operands.size() > 2) {
        const auto selector = decisions.valueOf(operands[0]);
        if (!selector) return false;
        uint32_t target = operands[1];
        for (size_t k = 2; k + 1 < operands.size(); k += 2)
            if (operands[k] == *selector) target = operands[k + 1];
        const uint32_t only[] = {operands[0], target};
        block.body.back() = module.make(OpSwitch, 0, 0, only);
        return true;
    }
    return false;
}

/// Keeps what can be reached. Merge blocks and continue targets that cannot be stay as stubs, since
/// their headers name them.
bool dropUnreachable(Module& module, Function& function) {
    Graph graph(module, function);
    std::vector<bool> isReached(function.blocks.size());
    std::vector<size_t> open = {0};
    isReached[0] = true;
    while (!open.empty()) {
        const size_t b = open.back();
        open.pop_back();
        graph.forEachSuccessor(function.blocks[b], [&](uint32_t label) {
            const size_t next = graph.indexOf(label);
            if (!isReached[next]) open.push_back(next);
            isReached[next] = true;
        });
    }
    const auto predecessors = graph.predecessors();
    const auto isReachedLabel = [&](uint32_t label) { return isReached[graph.indexOf(label)]; };
    bool changed = false;
    std::unordered_map<size_t, uint32_t> stubs; // block: the loop header that it continues, or 0
    for (size_t b = 0; b < function.blocks.size(); ++b) {
        Block& block = function.blocks[b];
        const Instruction* merge = isReached[b] ? mergeOf(block) : nullptr;
        if (merge == nullptr) continue;
        const auto operands = module.operands(*merge);
        const bool isLoop = merge->op == OpLoopMerge;
        if (isLoop && !isReachedLabel(operands[1])) {
            // A loop that is never repeated is none, unless it is left from within other
            // constructs.
            size_t exits = 0;
            for (const uint32_t from : predecessors[graph.indexOf(operands[0])])
                exits += isReachedLabel(from);
            if (exits <= 1) {
                dropMerge(block);
                changed = true;
                continue;
            }
            stubs[graph.indexOf(operands[1])] = block.label;
        }
        if (!isReachedLabel(operands[0])) stubs.insert({graph.indexOf(operands[0]), 0u});
    }
    std::vector<Block> kept;
    std::unordered_set<uint32_t> keptLabels;
    for (size_t b = 0; b < function.blocks.size(); ++b) {
        Block& block = function.blocks[b];
        const auto stub = stubs.find(b);
        if (!isReached[b] && stub == stubs.end()) {
            changed = true;
            continue;
        }
        if (!isReached[b]) {
            changed |= block.body.size() > 1;
            Instruction end = module.make(OpUnreachable, 0, 0, {});
            if (stub->second != 0) end = module.make(OpBranch, 0, 0, {&stub->second, 1});
            block.body = {end};
        }
        keptLabels.insert(block.label);
        kept.push_back(std::move(block));
    }
    function.blocks = std::move(kept);
    return changed;
}

/// Takes edges that are gone out of phis. The back edge of a stub brings the phi itself.
void repairPhis(Module& module, Function& function) {
    Graph graph(module, function);
    const auto predecessors = graph.predecessors();
    for (size_t b = 0; b < function.blocks.size(); ++b) {
        const auto& from = predecessors[b];
        for (Instruction& i : function.blocks[b].body) {
            if (i.op != OpPhi) break;
            const auto operands = module.operands(i);
            std::vector<uint32_t> kept;
            for (size_t k = 0; k < operands.size(); k += 2) {
                if (std::find(from.begin(), from.end(), operands[k + 1]) == from.end()) continue;
                const bool isStub = graph.block(operands[k + 1]).body.size() == 1 && k > 0 &&
                                    predecessors[graph.indexOf(operands[k + 1])].empty() &&
                                    operands[k + 1] != function.blocks[0].label;
                kept.insert(kept.end(), {isStub ? i.result : operands[k], operands[k + 1]});
            }
            if (kept.size() != operands.size() ||
                !std::equal(kept.begin(), kept.end(), operands.begin()))
                i = module.make(OpPhi, i.type, i.result, kept);
        }
    }
}

bool beginsWithPhi(const Block& block) {
    return block.body.front().op == OpPhi;
}

/// An `if` of which both ways lead to its merge block, through nothing at all, is none.
bool dropEmptySelections(Module& module, Function& function) {
    Graph graph(module, function);
    const auto predecessors = graph.predecessors();
    bool changed = false;
    for (Block& block : function.blocks) {
        const Instruction* merge = mergeOf(block);
        if (merge == nullptr || merge->op != OpSelectionMerge ||
            block.body.back().op != OpBranchConditional)
            continue;
        const uint32_t target = module.operands(*merge)[0];
        if (beginsWithPhi(graph.block(target))) continue;
        const auto isEmptyWay = [&](uint32_t label) {
            if (label == target) return true;
            const Block& way = graph.block(label);
            return way.body.size() == 1 && way.body[0].op == OpBranch &&
                   module.operands(way.body[0])[0] == target &&
                   predecessors[graph.indexOf(label)].size() == 1;
        };
        const auto operands = module.operands(block.body.back());
        if (!isEmptyWay(operands[1]) || !isEmptyWay(operands[2])) continue;
        dropMerge(block);
        goTo(module, block, target);
        changed = true;
    }
    return changed;
}

/// Appends a block to its only predecessor where that goes nowhere else and no header names the
/// block.
bool joinBlocks(Module& module, Function& function) {
    Graph graph(module, function);
    const auto predecessors = graph.predecessors();
    std::unordered_set<uint32_t> named;
    for (const Block& b : function.blocks) {
        const Instruction* merge = mergeOf(b);
        if (merge == nullptr) continue;
        const auto operands = module.operands(*merge);
        named.insert(operands.begin(), operands.begin() + (merge->op == OpLoopMerge ? 2 : 1));
    }
    std::vector<bool> isGone(function.blocks.size());
    std::unordered_map<uint32_t, uint32_t> nowIn;
    for (size_t b = 0; b < function.blocks.size(); ++b) {
        if (isGone[b]) continue;
        Block& block = function.blocks[b];
        for (;;) {
            const Instruction end = block.body.back();
            if (end.op != OpBranch || mergeOf(block) != nullptr) break;
            const uint32_t label = module.operands(end)[0];
            const size_t next = graph.indexOf(label);
            Block& follower = function.blocks[next];
            const Instruction* merge = mergeOf(follower);
            if (next == b || isGone[next] || named.contains(label) ||
                predecessors[next].size() != 1 || beginsWithPhi(follower) ||
                (merge != nullptr && merge->op == OpLoopMerge) || next < b)
                break;
            block.body.pop_back();
            block.body.insert(block.body.end(), follower.body.begin(), follower.body.end());
            isGone[next] = true;
            nowIn[label] = block.label;
        }
    }
    if (nowIn.empty()) return false;
    std::vector<Block> kept;
    for (size_t b = 0; b < function.blocks.size(); ++b)
        if (!isGone[b]) kept.push_back(std::move(function.blocks[b]));
    function.blocks = std::move(kept);
    const auto current = [&](uint32_t label) {
        for (auto found = nowIn.find(label); found != nowIn.end(); found = nowIn.find(label))
            label = found->second;
        return label;
    };
    for (Block& b : function.blocks)
        for (Instruction& i : b.body) {
            if (i.op != OpPhi) break;
            const auto operands = module.operands(i);
            for (size_t k = 1; k < operands.size(); k += 2)
                operands[k] = current(operands[k]);
        }
    return true;
}

} // namespace

bool simplifyControlFlow(Module& module) {
    bool changed = false;
    for (Function& f : module.functions) {
        if (f.blocks.empty()) continue;
        const Decisions decisions(module);
        Graph graph(module, f);
        const auto predecessors = graph.predecessors();
        for (Block& block : f.blocks)
            changed |= decideBranch(module, decisions, graph, predecessors, block);
        changed |= dropUnreachable(module, f);
        repairPhis(module, f);
        changed |= dropEmptySelections(module, f);
        changed |= dropUnreachable(module, f);
        repairPhis(module, f);
        changed |= joinBlocks(module, f);
    }
    return changed;
}

} // namespace stromboli::spirv
