#include "host/spirv/passes.hpp"

namespace stromboli::spirv {
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

} // namespace stromboli::spirv
