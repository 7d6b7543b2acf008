#include "host/spirv/values.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace stromboli::spirv {
namespace {

/// Folds the operations of one function's blocks into constants and equal values.
class Folder {
  public:
    Folder(Module& module, Values& values)
        : module_(module), values_(values), typeOf_(module.bound) {
        for (const Instruction& i : module_.globals)
            if (i.type != 0) typeOf_[i.result] = i.type;
        for (const Function& f : module_.functions)
            for (const Block& b : f.blocks)
                for (const Instruction& i : b.body)
                    if (i.type != 0) typeOf_[i.result] = i.type;
    }

    /// What an instruction's result is always equal to, or 0. Its operands have been replaced
    /// already.
    uint32_t equalTo(const Instruction& i) {
        const auto operands = module_.operands(i);
        if (i.op == OpPhi) return onlyValueOf(i);
        if (i.op == OpCopyObject) return operands[0];
        if (i.op == OpCompositeExtract) return partOf(i);
        if (const auto value = computed(values_, i.op, i.type, operands))
            return values_.constant(i.type, *value);
        if (i.op == OpSelect) {
            if (operands[1] == operands[2]) return operands[1];
            if (const auto condition = values_.valueOf(operands[0]))
                return *condition != 0 ? operands[1] : operands[2];
            return 0;
        }
        if (operands.size() != 2 || values_.kindOf(i.type) == Kind::Other) return 0;
        if (const uint32_t equal = byOneOperand(i, operands[0], operands[1], false)) return equal;
        return byOneOperand(i, operands[1], operands[0], true);
    }

    /// Notes what later instructions are simplified by, and goes past structures that were made in
    /// one piece where a part of a member is asked for.
    void prepare(Instruction& i) {
        if (i.op == OpCompositeConstruct && isStructure(i.type)) constructs_[i.result] = i;
        while (i.op == OpCompositeExtract && i.count > 2) {
            const auto operands = module_.operands(i);
            const auto made = constructs_.find(operands[0]);
            if (made == constructs_.end()) return;
            operands[1] = module_.operands(made->second)[operands[1]];
            ++i.at;
            --i.count;
        }
    }

  private:
    /// The value of a phi whose incoming values are all the same or the phi itself.
    uint32_t onlyValueOf(const Instruction& phi) const {
        const auto operands = module_.operands(phi);
        uint32_t only = 0;
        for (size_t k = 0; k < operands.size(); k += 2) {
            if (operands[k] == phi.result || operands[k] == only) continue;
            if (only != 0) return 0;
            only = operands[k];
        }
        return only;
    }

    /// The member that was put into a structure made in one piece.
    uint32_t partOf(const Instruction& i) const {
        const auto operands = module_.operands(i);
        const auto made = constructs_.find(operands[0]);
        if (made == constructs_.end() || operands.size() != 2) return 0;
        return module_.operands(made->second)[operands[1]];
    }

    bool isStructure(uint32_t type) {
        if (structures_.empty())
            for (const Instruction& g : module_.globals)
                if (g.op == OpTypeStruct) structures_[g.result] = true;
        return structures_.contains(type);
    }

    uint32_t typeOf(uint32_t number) const { return number < typeOf_.size() ? typeOf_[number] : 0; }

    /// Where one operand is a constant that decides the result, or makes it the other operand.
    uint32_t byOneOperand(const Instruction& i, uint32_t constant, uint32_t other, bool isSecond) {
        const auto value = values_.valueOf(constant);
        if (!value) return 0;
        const bool keeps = typeOf(other) == i.type;
        switch (i.op) {
        case OpLogicalAnd:
            return *value == 0 ? values_.constant(i.type, 0) : other;
        case OpLogicalOr:
            return *value != 0 ? values_.constant(i.type, 1) : other;
        case OpLogicalEqual:
            return *value != 0 ? other : 0;
        case OpLogicalNotEqual:
            return *value == 0 ? other : 0;
        case OpBitwiseAnd:
        case OpIMul:
            if (*value == 0) return values_.constant(i.type, 0);
            return i.op == OpIMul && *value == 1 && keeps ? other : 0;
        case OpIAdd:
        case OpBitwiseOr:
        case OpBitwiseXor:
            return *value == 0 && keeps ? other : 0;
        case OpISub:
        case OpShiftLeftLogical:
        case OpShiftRightLogical:
        case OpShiftRightArithmetic:
            return isSecond && *value == 0 && keeps ? other : 0;
        default:
            return 0;
        }
    }

    Module& module_;
    Values& values_;
    std::vector<uint32_t> typeOf_;
    std::unordered_map<uint32_t, Instruction> constructs_;
    std::unordered_map<uint32_t, bool> structures_;
};

/// Marks the blocks that a block may go on to, but for ways that a constant rules out.
void markReached(const Module& module, const Values& values, const Block& block,
                 std::vector<bool>& isReached) {
    const Instruction& end = block.body.back();
    const auto operands = module.operands(end);
    if (end.op == OpBranch) isReached[operands[0]] = true;
    if (end.op == OpBranchConditional) {
        const auto condition = values.valueOf(operands[0]);
        if (condition.value_or(1) != 0) isReached[operands[1]] = true;
        if (condition.value_or(0) == 0) isReached[operands[2]] = true;
    }
    if (end.op == OpSwitch)
        for (size_t k = 1; k < operands.size(); k += 2)
            isReached[operands[k]] = true;
}

void replaceOperands(Module& module, const Values& values, const Instruction& i) {
    forEachNumber(i, module.operands(i),
                  [&](uint32_t& number) { number = values.resolve(number); });
}

} // namespace

void setConstants(Module& module, std::span<const uint32_t> constants) {
    std::unordered_map<uint32_t, uint32_t> idOf; // specialisation constants by number
    std::erase_if(module.decorations, [&](const Instruction& d) {
        const auto operands = module.operands(d);
        if (d.op != OpDecorate || operands[1] != kDecorationSpecId) return false;
        idOf[operands[0]] = operands[2];
        return true;
    });
    const auto given = [&](uint32_t number) -> std::optional<uint32_t> {
        const auto id = idOf.find(number);
        if (id == idOf.end() || id->second >= constants.size()) return {};
        return constants[id->second];
    };
    for (Instruction& i : module.globals) {
        if (i.op == OpSpecConstantTrue || i.op == OpSpecConstantFalse) {
            const bool value = given(i.result).value_or(i.op == OpSpecConstantTrue ? 1u : 0u) != 0;
            i.op = value ? OpConstantTrue : OpConstantFalse;
        } else if (i.op == OpSpecConstant) {
            if (const auto value = given(i.result); value && i.count == 1)
                module.operands(i)[0] = *value;
            i.op = OpConstant;
        } else if (i.op == OpSpecConstantComposite) {
            i.op = OpConstantComposite;
        }
    }
    std::vector<Instruction> before;
    before.swap(module.globals);
    Values values(module);
    for (Instruction i : before) {
        if (i.op == OpSpecConstantOp) {
            const auto operands = module.operands(i);
            if (const auto value =
                    computed(values, uint16_t(operands[0]), i.type, operands.subspan(1))) {
                const bool isBool = values.kindOf(i.type) == Kind::Bool;
                const uint32_t word = *value;
                i = isBool ? module.make(word != 0 ? OpConstantTrue : OpConstantFalse, i.type,
                                         i.result, {})
                           : module.make(OpConstant, i.type, i.result, {&word, 1});
            }
        }
        module.globals.push_back(i);
        values.enter(i);
    }
}

bool fold(Module& module) {
    Values values(module);
    Folder folder(module, values);
    bool changed = false;
    for (const Instruction& i : module.globals)
        replaceOperands(module, values, i);
    for (Function& f : module.functions) {
        // Values of a block that comes later, as phis of loops have, are replaced in a second
        // round. Nor is a block looked at that nothing before it goes on to: most are unreachable
        // in the first round.
        std::vector<bool> isReached(module.bound);
        if (!f.blocks.empty()) isReached[f.blocks[0].label] = true;
        for (Block& b : f.blocks) {
            if (!isReached[b.label]) continue;
            std::vector<Instruction> kept;
            kept.reserve(b.body.size());
            for (Instruction i : b.body) {
                replaceOperands(module, values, i);
                folder.prepare(i);
                if (const uint32_t equal = i.result != 0 ? folder.equalTo(i) : 0) {
                    values.replace(i.result, equal);
                    changed = true;
                } else {
                    kept.push_back(i);
                }
            }
            b.body = std::move(kept);
            markReached(module, values, b, isReached);
        }
        for (const Block& b : f.blocks)
            if (isReached[b.label])
                for (const Instruction& i : b.body)
                    replaceOperands(module, values, i);
    }
    return changed;
}

} // namespace stromboli::spirv
