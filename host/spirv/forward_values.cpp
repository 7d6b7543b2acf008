#include "host/spirv/graph.hpp"

#include <optional>

namespace stromboli::spirv {
namespace {

/// For each block, by index, the one that every way to it passes last; the first block's is itself.
/// By the algorithm of Cooper, Harvey and Kennedy (2001, "A Simple, Fast Dominance Algorithm"), for
/// which it is enough that blocks come after those that dominate them (SPIR-V
/// specification, 2.16.1): in another order than theirs it takes more rounds to the same end.
class Dominators {
  public:
    explicit Dominators(const Graph& graph, const std::vector<std::vector<uint32_t>>& predecessors)
        : above_(predecessors.size(), kUnknown) {
        if (above_.empty()) return;
        above_[0] = 0;
        for (bool changed = true; changed;) {
            changed = false;
            for (size_t b = 1; b < above_.size(); ++b) {
                size_t now = kUnknown;
                for (const uint32_t label : predecessors[b]) {
                    const size_t from = graph.indexOf(label);
                    if (above_[from] == kUnknown) continue;
                    now = now == kUnknown ? from : meet(now, from);
                }
                changed |= above_[b] != now;
                above_[b] = now;
            }
        }
    }

    bool dominates(size_t first, size_t b) const {
        if (above_[b] == kUnknown) return false;
        while (b > first)
            b = above_[b];
        return b == first;
    }

  private:
    static constexpr size_t kUnknown = SIZE_MAX; ///< cannot be reached

    size_t meet(size_t a, size_t b) const {
        while (a != b)
            (a > b ? a : b) = above_[a > b ? a : b];
        return a;
    }

    std::vector<size_t> above_;
};

/// Puts what was stored in the place of loads.
class Forwarder {
  public:
    Forwarder(Module& module, Function& function)
        : module_(module), function_(function), replacedBy_(module.bound), variables_(module.bound),
          root_(module.bound) {
        findVariables();
    }

    bool run() {
        for (Block& b : function_.blocks)
            forwardInBlock(b);
        forwardSingleStores();
        if (!changed_) return false;
        for (Block& b : function_.blocks)
            for (const Instruction& i : b.body)
                forEachNumber(i, module_.operands(i),
                              [&](uint32_t& number) { number = resolve(number); });
        return true;
    }

  private:
    /// A variable of the function.
    struct Variable {
        bool isPlain = false; ///< it is loaded and stored, as a whole or in parts, and nothing else
        bool isStoredInParts = false;
        size_t stores = 0; ///< of the whole, or of parts
    };

    void findVariables() {
        for (const Block& b : function_.blocks)
            for (const Instruction& i : b.body) {
                const auto operands = module_.operands(i);
                if (i.op == OpVariable) {
                    variables_[i.result].isPlain = i.count == 1;
                    root_[i.result] = i.result;
                }
                const bool isPart = i.op == OpAccessChain || i.op == OpInBoundsAccessChain;
                if (isPart) root_[i.result] = root_[operands[0]];
                const bool isAccess =
                    isPart || (i.op == OpLoad && i.count == 1) || (i.op == OpStore && i.count == 2);
                size_t position = 0;
                forEachNumber(i, operands, [&](uint32_t number) {
                    const bool isPointer = position++ == 0;
                    if (root_[number] != 0 && !(isPointer && isAccess))
                        variables_[root_[number]].isPlain = false;
                });
            }
    }

    bool isPlain(uint32_t number) const { return variables_[number].isPlain; }
    /// Whether a pointer leads to a part of a variable.
    bool isPart(uint32_t number) const { return root_[number] != 0 && root_[number] != number; }

    uint32_t resolve(uint32_t number) const {
        while (replacedBy_[number] != 0)
            number = replacedBy_[number];
        return number;
    }

    void replaceLoad(const Instruction& load, uint32_t value) {
        replacedBy_[load.result] = resolve(value);
        changed_ = true;
    }

    /// Loads behind a store or another load of the same block, and stores before another one.
    void forwardInBlock(Block& block) {
        struct Known {
            uint32_t value = 0;
            size_t unreadStore = 0; ///< position in `kept`, from 1; 0: none, or it is read
        };
        std::unordered_map<uint32_t, Known> known;
        std::vector<Instruction> kept;
        std::vector<bool> isUnread;
        kept.reserve(block.body.size());
        for (const Instruction& i : block.body) {
            const auto operands = module_.operands(i);
            const bool isAccess = (i.op == OpLoad || i.op == OpStore) && isPlain(operands[0]);
            if ((i.op == OpLoad || i.op == OpStore) && isPart(operands[0])) {
                Known& k = known[root_[operands[0]]];
                k = {i.op == OpLoad ? k.value : 0, 0};
            }
            if (isAccess && i.op == OpLoad) {
                Known& k = known[operands[0]];
                if (k.value != 0) {
                    replaceLoad(i, k.value);
                    continue;
                }
                k = {i.result, 0};
            }
            if (isAccess && i.op == OpStore) {
                Known& k = known[operands[0]];
                if (k.value != 0 && resolve(k.value) == resolve(operands[1])) {
                    changed_ = true; // it is there already
                    continue;
                }
                if (k.unreadStore != 0) isUnread[k.unreadStore - 1] = true;
                k = {operands[1], kept.size() + 1};
            }
            kept.push_back(i);
            isUnread.push_back(false);
        }
        block.body.clear();
        for (size_t k = 0; k < kept.size(); ++k) {
            if (!isUnread[k]) block.body.push_back(kept[k]);
            changed_ |= isUnread[k];
        }
    }

    /// Loads that the only store of a variable dominates. Its value cannot have been computed anew
    /// since: every way from there to the load would pass the store again.
    void forwardSingleStores() {
        struct Store {
            size_t block = 0;
            uint32_t value = 0;
        };
        std::unordered_map<uint32_t, Store> only;
        for (size_t b = 0; b < function_.blocks.size(); ++b)
            for (const Instruction& i : function_.blocks[b].body)
                if (i.op == OpStore && root_[module_.operands(i)[0]] != 0) {
                    const uint32_t pointer = module_.operands(i)[0];
                    Variable& variable = variables_[root_[pointer]];
                    variable.isStoredInParts |= isPart(pointer);
                    ++variable.stores;
                    only[root_[pointer]] = {b, module_.operands(i)[1]};
                }
        Graph graph(module_, function_);
        const Dominators dominators(graph, graph.predecessors());
        for (size_t b = 0; b < function_.blocks.size(); ++b)
            std::erase_if(function_.blocks[b].body, [&](const Instruction& i) {
                if (i.op != OpLoad || !isPlain(module_.operands(i)[0])) return false;
                const uint32_t variable = module_.operands(i)[0];
                if (variables_[variable].stores != 1 || variables_[variable].isStoredInParts)
                    return false;
                // Loads behind the store in its own block are gone already.
                const Store& store = only[variable];
                if (store.block == b || !dominators.dominates(store.block, b)) return false;
                replaceLoad(i, store.value);
                return true;
            });
    }

    Module& module_;
    Function& function_;
    std::vector<uint32_t> replacedBy_; ///< by number; 0: by nothing
    std::vector<Variable> variables_;  ///< by number
    std::vector<uint32_t> root_; ///< of a pointer: the function's variable that it leads into, or 0
    bool changed_ = false;
};

} // namespace

bool forwardValues(Module& module) {
    bool changed = false;
    for (Function& f : module.functions)
        changed |= Forwarder(module, f).run();
    return changed;
}

} // namespace stromboli::spirv
