#include "host/spirv/module.hpp"

#include <map>
#include <utility>

namespace stromboli::spirv {

// --- Dead code -----------------------------------------------------------------------------------

namespace {

bool isOwnMemory(uint32_t storage) {
    return storage == kStorageFunction || storage == kStoragePrivate;
}

/// Marks what is read, from the instructions with effects on. A store to a variable of the
/// invocation's own is read once the variable is.
class Marker {
  public:
    explicit Marker(Module& module)
        : module_(module), isLive_(module.bound), defined_(module.bound), root_(module.bound),
          isRead_(module.bound) {
        for (const Instruction& i : module_.globals)
            define(i);
        for (const Function& f : module_.functions)
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    define(i);
    }

    void markFromEffects() {
        for (const Function& f : module_.functions) {
            mark(f.head.type);
            mark(module_.operands(f.head)[1]);
            for (const Instruction& p : f.parameters)
                mark(p.type);
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    if (hasEffect(i.op) ||
                        (i.op == OpStore && isAlwaysRead(module_.operands(i)[0])))
                        use(i);
        }
        for (const Instruction& d : module_.decorations) {
            const auto operands = module_.operands(d);
            if (d.op == OpDecorate && operands.size() > 2 && operands[1] == kDecorationBuiltIn &&
                operands[2] == kBuiltInWorkgroupSize)
                mark(operands[0]);
        }
        while (!open_.empty()) {
            const Instruction i = open_.back();
            open_.pop_back();
            use(i);
        }
    }

    bool isLive(uint32_t number) const { return isLive_[number]; }

    bool keeps(const Instruction& i) const {
        if (i.op == OpStore) {
            const uint32_t variable = root_[module_.operands(i)[0]];
            return variable == 0 || isRead_[variable];
        }
        return hasEffect(i.op) || isLive_[i.result];
    }

  private:
    void define(const Instruction& i) {
        if (i.result != 0) defined_[i.result] = i;
        const auto operands = module_.operands(i);
        if (i.op == OpVariable && isOwnMemory(operands[0])) root_[i.result] = i.result;
        if (i.op == OpAccessChain || i.op == OpInBoundsAccessChain || i.op == OpCopyObject)
            root_[i.result] = root_[operands[0]];
        if (i.op == OpStore && root_[operands[0]] != 0) stores_[root_[operands[0]]].push_back(i);
    }

    bool isAlwaysRead(uint32_t pointer) const { return root_[pointer] == 0; }

    void mark(uint32_t number) {
        if (number == 0 || number >= isLive_.size() || isLive_[number]) return;
        isLive_[number] = true;
        if (defined_[number].op != 0) open_.push_back(defined_[number]);
    }

    /// What the instruction needs is live; a variable that it names, otherwise than to store there,
    /// is read.
    void use(const Instruction& i) {
        mark(i.type);
        const bool isStore = i.op == OpStore, isChain = root_[i.result] != 0;
        bool isFirst = true;
        forEachNumber(i, module_.operands(i), [&](uint32_t number) {
            if (number >= isLive_.size()) return;
            if (root_[number] != 0 && !isChain && !(isStore && isFirst)) read(root_[number]);
            isFirst = false;
            mark(number);
        });
    }

    void read(uint32_t variable) {
        if (isRead_[variable]) return;
        isRead_[variable] = true;
        mark(variable);
        for (const Instruction& store : stores_[variable])
            open_.push_back(store);
    }

    Module& module_;
    std::vector<bool> isLive_;
    std::vector<Instruction> defined_; ///< by number
    std::vector<uint32_t>
        root_; ///< of a pointer: the variable of the invocation's own that it leads into
    std::vector<bool> isRead_;
    std::unordered_map<uint32_t, std::vector<Instruction>> stores_;
    std::vector<Instruction> open_;
};

/// Functions that the entry point does not call, directly or not.
void dropUncalledFunctions(Module& module) {
    std::unordered_map<uint32_t, const Function*> byNumber;
    for (const Function& f : module.functions)
        byNumber[f.head.result] = &f;
    std::unordered_map<uint32_t, bool> isCalled;
    std::vector<uint32_t> open;
    for (const Instruction& i : module.preamble)
        if (i.op == OpEntryPoint) open.push_back(module.operands(i)[1]);
    while (!open.empty()) {
        const uint32_t number = open.back();
        open.pop_back();
        if (isCalled[number] || !byNumber.contains(number)) continue;
        isCalled[number] = true;
        for (const Block& b : byNumber[number]->blocks)
            for (const Instruction& i : b.body)
                if (i.op == OpFunctionCall) open.push_back(module.operands(i)[0]);
    }
    std::erase_if(module.functions, [&](const Function& f) { return !isCalled[f.head.result]; });
}

} // namespace

void dropDeadCode(Module& module) {
    dropUncalledFunctions(module);
    Marker marker(module);
    marker.markFromEffects();
    for (Function& f : module.functions)
        for (Block& b : f.blocks)
            std::erase_if(b.body, [&](const Instruction& i) { return !marker.keeps(i); });
    std::erase_if(module.globals, [&](const Instruction& i) { return !marker.isLive(i.result); });
}

// --- Arrays and structures as variables ----------------------------------------------------------

namespace {

/// A variable of a structure that is taken apart, and the variables of its members.
struct Split {
    uint32_t storage = 0;
    std::vector<uint32_t> memberTypes, members;
};

class Splitter {
  public:
    explicit Splitter(Module& module) : module_(module) {
        for (const Instruction& i : module_.globals) {
            const auto operands = module_.operands(i);
            if (i.op == OpTypeStruct) structures_[i.result] = {operands.begin(), operands.end()};
            if (i.op == OpTypePointer) {
                pointers_[{operands[0], operands[1]}] = i.result;
                pointees_[i.result] = operands[1];
            }
            if (i.op == OpConstant && i.count == 1) constants_[i.result] = operands[0];
        }
    }

    bool run() {
        for (const Instruction& i : module_.globals)
            consider(i);
        for (const Function& f : module_.functions)
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    consider(i);
        for (const Function& f : module_.functions)
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    checkUse(i);
        if (splits_.empty()) return false;
        for (auto& [variable, split] : splits_)
            makeMembers(split);
        splitGlobals();
        for (Function& f : module_.functions)
            splitFunction(f);
        return true;
    }

  private:
    void consider(const Instruction& i) {
        if (i.op != OpVariable || i.count != 1) return;
        const uint32_t storage = module_.operands(i)[0];
        if (storage != kStorageFunction && storage != kStoragePrivate) return;
        const auto structure = structures_.find(pointees_[i.type]);
        if (structure != structures_.end()) splits_[i.result] = {storage, structure->second, {}};
    }

    /// Only loads and stores of the whole and constant members leave a variable among those to be
    /// split.
    void checkUse(const Instruction& i) {
        if (i.op == OpVariable) return;
        const auto operands = module_.operands(i);
        const bool isChain = i.op == OpAccessChain || i.op == OpInBoundsAccessChain;
        size_t position = 0;
        forEachNumber(i, operands, [&](uint32_t number) {
            const bool isPointer = position++ == 0;
            if (!splits_.contains(number)) return;
            const bool isMember =
                isChain && operands.size() > 1 && constants_.contains(operands[1]);
            if (!isPointer || !(i.op == OpLoad || i.op == OpStore || isMember))
                splits_.erase(number);
        });
    }

    uint32_t pointerTo(uint32_t storage, uint32_t type) {
        uint32_t& pointer = pointers_[{storage, type}];
        if (pointer == 0) {
            pointer = module_.newNumber();
            const uint32_t operands[] = {storage, type};
            made_.push_back(module_.make(OpTypePointer, 0, pointer, operands));
            pointees_[pointer] = type;
        }
        return pointer;
    }

    void makeMembers(Split& split) {
        for (const uint32_t type : split.memberTypes) {
            pointerTo(split.storage, type);
            split.members.push_back(module_.newNumber());
        }
    }

    void declareMembers(const Split& split, std::vector<Instruction>& into) {
        for (size_t m = 0; m < split.members.size(); ++m)
            into.push_back(module_.make(OpVariable, pointerTo(split.storage, split.memberTypes[m]),
                                        split.members[m], {&split.storage, 1}));
    }

    void splitGlobals() {
        module_.globals.insert(module_.globals.end(), made_.begin(), made_.end());
        std::vector<Instruction> kept;
        for (const Instruction& i : module_.globals) {
            const auto split = i.op == OpVariable ? splits_.find(i.result) : splits_.end();
            if (split == splits_.end())
                kept.push_back(i);
            else
                declareMembers(split->second, kept);
        }
        module_.globals = std::move(kept);
    }

    void splitFunction(Function& function) {
        for (Block& b : function.blocks) {
            std::vector<Instruction> kept;
            kept.reserve(b.body.size());
            for (const Instruction& i : b.body)
                rewrite(i, kept);
            b.body = std::move(kept);
        }
        for (Block& b : function.blocks)
            for (const Instruction& i : b.body)
                forEachNumber(i, module_.operands(i), [&](uint32_t& number) {
                    if (const auto by = replaced_.find(number); by != replaced_.end())
                        number = by->second;
                });
    }

    void rewrite(const Instruction& i, std::vector<Instruction>& kept) {
        const auto operands = module_.operands(i);
        const auto split = i.op == OpVariable ? splits_.find(i.result)
                           : operands.empty() ? splits_.end()
                                              : splits_.find(operands[0]);
        const bool isAccess = i.op == OpVariable || i.op == OpLoad || i.op == OpStore ||
                              i.op == OpAccessChain || i.op == OpInBoundsAccessChain;
        if (split == splits_.end() || !isAccess) {
            kept.push_back(i);
            return;
        }
        const Split& s = split->second;
        if (i.op == OpVariable) {
            declareMembers(s, kept);
        } else if (i.op == OpLoad) {
            std::vector<uint32_t> parts;
            for (size_t m = 0; m < s.members.size(); ++m) {
                parts.push_back(module_.newNumber());
                kept.push_back(
                    module_.make(OpLoad, s.memberTypes[m], parts.back(), {&s.members[m], 1}));
            }
            kept.push_back(module_.make(OpCompositeConstruct, i.type, i.result, parts));
        } else if (i.op == OpStore) {
            const uint32_t value = operands[1];
            for (size_t m = 0; m < s.members.size(); ++m) {
                const uint32_t part = module_.newNumber();
                const uint32_t from[] = {value, uint32_t(m)}, to[] = {s.members[m], part};
                kept.push_back(module_.make(OpCompositeExtract, s.memberTypes[m], part, from));
                kept.push_back(module_.make(OpStore, 0, 0, to));
            }
        } else if (operands.size() == 2) {
            replaced_[i.result] = s.members[constants_[operands[1]]];
        } else {
            std::vector<uint32_t> deeper = {s.members[constants_[operands[1]]]};
            deeper.insert(deeper.end(), operands.begin() + 2, operands.end());
            kept.push_back(module_.make(i.op, i.type, i.result, deeper));
        }
    }

    Module& module_;
    std::unordered_map<uint32_t, std::vector<uint32_t>> structures_; ///< members' types
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> pointers_;     ///< by storage and type
    std::unordered_map<uint32_t, uint32_t> pointees_, constants_, replaced_;
    std::vector<Instruction> made_;
    std::map<uint32_t, Split> splits_; ///< by variable, in an order that does not depend on a hash
};

} // namespace

bool splitStructures(Module& module) {
    return Splitter(module).run();
}

} // namespace stromboli::spirv
