#include "host/spirv/graph.hpp"
#include "host/spirv/values.hpp"

#include <algorithm>
#include <optional>
#include <unordered_set>

namespace stromboli::spirv {
namespace {

/// Loops are unrolled up to so many times, and to so many instructions, as Mesa would unroll them;
/// one that runs once is unrolled whatever its size.
constexpr size_t kMostTimes = 32, kMostInstructions = 832;

/// A loop over a variable from one constant to another, which nothing leaves from within:
///
///     first:  variable = constant; go to header
///     header: go to test
///     test:   go to the body, or to the end, by a condition on the variable
///     ...     body
///     next:   variable = f(variable); go to header
struct CountedLoop {
    size_t header = 0, test = 0, next = 0; ///< blocks, by index
    uint32_t end = 0;                      ///< label of the merge block
    uint32_t body = 0;                     ///< label that the test goes on to
    uint32_t variable = 0;
    std::vector<size_t> blocks;   ///< from the test to `next`, in their order
    std::vector<uint32_t> values; ///< of the variable, one for each time
    uint32_t last = 0;            ///< its value at the end
};

/// Loops of one function, as it is before one is unrolled.
class Loops {
  public:
    Loops(Module& module, Function& function, Values& values)
        : module_(module), function_(function), values_(values), graph_(module, function),
          predecessors_(graph_.predecessors()), constructs_(module, graph_, function) {}

    bool unrollOne() {
        // Inner loops come after those that they are in.
        for (size_t b = function_.blocks.size(); b-- > 0;) {
            const Instruction* merge = mergeOf(function_.blocks[b]);
            if (merge == nullptr || merge->op != OpLoopMerge) continue;
            if (const std::optional<CountedLoop> loop = countedLoop(b)) {
                unroll(*loop);
                return true;
            }
        }
        return false;
    }

  private:
    const std::vector<uint32_t>& from(uint32_t label) const {
        return predecessors_[graph_.indexOf(label)];
    }

    std::optional<CountedLoop> countedLoop(size_t header) {
        const Block& top = function_.blocks[header];
        const auto named = module_.operands(*mergeOf(top));
        CountedLoop loop;
        loop.header = header, loop.end = named[0], loop.next = graph_.indexOf(named[1]);
        if (top.body.size() != 2 || top.body[1].op != OpBranch) return {};
        loop.test = graph_.indexOf(module_.operands(top.body[1])[0]);
        const Block &test = function_.blocks[loop.test], &next = function_.blocks[loop.next];
        if (test.body.back().op != OpBranchConditional || mergeOf(test) != nullptr ||
            next.body.back().op != OpBranch || mergeOf(next) != nullptr ||
            module_.operands(next.body.back())[0] != top.label)
            return {};
        const auto ways = module_.operands(test.body.back());
        loop.body = ways[1];
        const bool isLeftByItsTest = ways[2] == loop.end && loop.body != loop.end &&
                                     from(loop.end).size() == 1 && from(test.label).size() == 1 &&
                                     from(next.label).size() == 1 && from(top.label).size() == 2;
        // No `continue` goes there from within a construct.
        if (!isLeftByItsTest || constructs_.headerOf(from(next.label)[0]) != top.label) return {};
        if (!findBlocks(loop) || !findVariable(loop) || !count(loop)) return {};
        return loop;
    }

    /// All that the test can reach before the loop ends.
    bool findBlocks(CountedLoop& loop) {
        std::vector<bool> isIn(function_.blocks.size());
        isIn[loop.header] = true; // where `next` goes
        std::vector<size_t> open = {loop.test};
        isIn[loop.test] = true;
        const auto enter = [&](uint32_t label) {
            const size_t b = graph_.indexOf(label);
            if (label == loop.end || isIn[b]) return;
            isIn[b] = true;
            open.push_back(b);
        };
        while (!open.empty()) {
            const Block& block = function_.blocks[open.back()];
            open.pop_back();
            graph_.forEachSuccessor(block, enter);
            if (const Instruction* merge = mergeOf(block)) // blocks that only headers name
                for (size_t k = 0; k < (merge->op == OpLoopMerge ? 2u : 1u); ++k)
                    enter(module_.operands(*merge)[k]);
            const uint16_t op = block.body.back().op;
            if (op == OpReturn || op == OpReturnValue || op == OpKill) return false;
        }
        isIn[loop.header] = false;
        for (size_t b = 0; b < isIn.size(); ++b) {
            if (!isIn[b]) continue;
            // Whatever enters from elsewhere, other than by the header, is not looked at.
            for (const uint32_t label : predecessors_[b])
                if (!isIn[graph_.indexOf(label)] && b != loop.test) return false;
            loop.blocks.push_back(b);
        }
        return true;
    }

    /// The variable that the test reads and `next` sets, and no one else in the loop.
    bool findVariable(CountedLoop& loop) {
        for (const Instruction& i : function_.blocks[loop.test].body) {
            if (i.op != OpLoad) continue;
            loop.variable = module_.operands(i)[0];
            if (isLocal(loop.variable) && isSetByNextAlone(loop)) return true;
        }
        return false;
    }

    bool isSetByNextAlone(const CountedLoop& loop) const {
        size_t stores = 0;
        for (const size_t b : loop.blocks)
            for (const Instruction& i : function_.blocks[b].body) {
                bool isNamed = false;
                forEachNumber(i, module_.operands(i),
                              [&](uint32_t number) { isNamed |= number == loop.variable; });
                if (!isNamed || (i.op == OpLoad && i.count == 1)) continue;
                const bool isStore =
                    i.op == OpStore && i.count == 2 && module_.operands(i)[0] == loop.variable;
                if (!isStore || b != loop.next) return false;
                ++stores;
            }
        return stores == 1;
    }

    bool isLocal(uint32_t variable) const {
        for (const Instruction& i : function_.blocks[0].body)
            if (i.op == OpVariable && i.result == variable) return true;
        return false;
    }

    /// What a block makes of the variable, and of its condition; only constants may be in it.
    struct Computed {
        std::optional<uint32_t> variable, condition;
    };

    Computed compute(const Block& block, uint32_t variable, uint32_t value) {
        std::unordered_map<uint32_t, uint32_t> known; // result: a constant's number
        Computed result{value, {}};
        const auto constantOf = [&](uint32_t number) {
            const auto found = known.find(number);
            return found == known.end() ? number : found->second;
        };
        for (const Instruction& i : block.body) {
            const auto operands = module_.operands(i);
            if (i.op == OpLoad && operands[0] == variable && result.variable) {
                known[i.result] = values_.constant(i.type, *result.variable);
                continue; // operands may lie elsewhere now
            }
            if (i.op == OpStore && operands[0] == variable)
                result.variable = values_.valueOf(constantOf(operands[1]));
            if (i.op == OpBranchConditional)
                result.condition = values_.valueOf(constantOf(operands[0]));
            if (i.result == 0) continue;
            std::vector<uint32_t> resolved;
            for (const uint32_t number : operands)
                resolved.push_back(constantOf(number));
            if (const auto folded = computed(values_, i.op, i.type, resolved))
                known[i.result] = values_.constant(i.type, *folded);
        }
        return result;
    }

    bool count(CountedLoop& loop) {
        const uint32_t next = function_.blocks[loop.next].label;
        const Block& top = function_.blocks[loop.header];
        const auto& entries = from(top.label);
        const Block& first = graph_.block(entries[0] == next ? entries[1] : entries[0]);
        std::optional<uint32_t> value;
        for (const Instruction& i : first.body)
            if (i.op == OpStore && module_.operands(i)[0] == loop.variable)
                value = values_.valueOf(module_.operands(i)[1]);
        size_t size = 0;
        for (const size_t b : loop.blocks)
            size += function_.blocks[b].body.size();
        while (value) {
            const Computed tested = compute(function_.blocks[loop.test], loop.variable, *value);
            if (!tested.condition || tested.variable != value) return false;
            if (*tested.condition == 0) {
                loop.last = *value;
                return true;
            }
            loop.values.push_back(*value);
            const bool isLong =
                loop.values.size() > 1 && loop.values.size() * size > kMostInstructions;
            if (loop.values.size() > kMostTimes || isLong) return false;
            value = compute(function_.blocks[loop.next], loop.variable, *value).variable;
        }
        return false;
    }

    /// A copy of the loop's blocks for each time, one after the other, and the test once more,
    /// which fails and keeps its numbers, as those may be read behind the loop.
    void unroll(const CountedLoop& loop) {
        std::vector<Block> copies;
        std::vector<uint32_t> tests; // labels, of each time
        for (size_t time = 0; time < loop.values.size(); ++time)
            tests.push_back(module_.newNumber());
        tests.push_back(function_.blocks[loop.test].label);
        for (size_t time = 0; time < loop.values.size(); ++time)
            copy(loop, time, tests, copies);
        Block& test = function_.blocks[loop.test];
        setLoads(test, loop.variable, loop.last);
        goTo(module_, test, loop.end);
        Block& top = function_.blocks[loop.header];
        dropMerge(top);
        goTo(module_, top, tests[0]);
        std::unordered_set<size_t> isGone(loop.blocks.begin(), loop.blocks.end());
        copies.push_back(std::move(test));
        std::vector<Block> kept;
        for (size_t b = 0; b < function_.blocks.size(); ++b) {
            if (!isGone.contains(b)) kept.push_back(std::move(function_.blocks[b]));
            if (b == loop.header) std::ranges::move(copies, std::back_inserter(kept));
        }
        function_.blocks = std::move(kept);
    }

    void copy(const CountedLoop& loop, size_t time, std::span<const uint32_t> tests,
              std::vector<Block>& copies) {
        std::unordered_map<uint32_t, uint32_t> numbers; // of the loop: in this copy
        for (const size_t b : loop.blocks) {
            const Block& block = function_.blocks[b];
            numbers[block.label] = b == loop.test ? tests[time] : module_.newNumber();
            for (const Instruction& i : block.body)
                if (i.result != 0) numbers[i.result] = module_.newNumber();
        }
        decorateCopies(numbers);
        numbers[function_.blocks[loop.header].label] = tests[time + 1];
        for (const size_t b : loop.blocks) {
            const Block& block = function_.blocks[b];
            Block copied{.label = numbers.at(block.label)};
            for (const Instruction& i : block.body) {
                std::vector<uint32_t> operands(module_.operands(i).begin(),
                                               module_.operands(i).end());
                forEachNumber(i, std::span(operands), [&](uint32_t& number) {
                    if (const auto found = numbers.find(number); found != numbers.end())
                        number = found->second;
                });
                const uint32_t result = i.result != 0 ? numbers.at(i.result) : 0;
                copied.body.push_back(module_.make(i.op, i.type, result, operands));
            }
            setLoads(copied, loop.variable, loop.values[time]);
            if (b == loop.test) goTo(module_, copied, numbers.at(loop.body));
            copies.push_back(std::move(copied));
        }
    }

    /// What is said of a result, such as that it must not be fused with others (`precise`), holds
    /// for its copies, too.
    void decorateCopies(const std::unordered_map<uint32_t, uint32_t>& numbers) {
        const size_t count = module_.decorations.size();
        for (size_t d = 0; d < count; ++d) {
            const Instruction decoration = module_.decorations[d];
            std::vector<uint32_t> operands(module_.operands(decoration).begin(),
                                           module_.operands(decoration).end());
            const auto copy = numbers.find(operands[0]);
            if (copy == numbers.end()) continue;
            operands[0] = copy->second;
            module_.decorations.push_back(module_.make(decoration.op, 0, 0, operands));
        }
    }

    /// Puts the variable's value in the place of its loads, up to where the block sets it.
    void setLoads(Block& block, uint32_t variable, uint32_t value) {
        for (Instruction& i : block.body) {
            const bool isOfIt =
                (i.op == OpLoad || i.op == OpStore) && module_.operands(i)[0] == variable;
            if (isOfIt && i.op == OpStore) return;
            if (!isOfIt) continue;
            const uint32_t constant = values_.constant(i.type, value);
            i = module_.make(OpCopyObject, i.type, i.result, {&constant, 1});
        }
    }

    Module& module_;
    Function& function_;
    Values& values_;
    Graph graph_;
    std::vector<std::vector<uint32_t>> predecessors_;
    Constructs constructs_;
};

} // namespace

bool unrollLoops(Module& module) {
    bool changed = false;
    Values values(module);
    for (Function& f : module.functions)
        while (!f.blocks.empty() && Loops(module, f, values).unrollOne())
            changed = true;
    return changed;
}

} // namespace stromboli::spirv
