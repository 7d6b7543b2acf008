#include "host/spirv/grammar.hpp"
#include "host/spirv/module.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace stromboli::spirv {
namespace {

// --- Arithmetic of constants ---------------------------------------------------------------------

/// The result of an operation on 32-bit integers or booleans (0 or 1), by the words of its one to
/// three operands; nothing if it is undefined or not computed here. The operation has to be one
/// that isComputed().
std::optional<uint32_t> evaluate(uint16_t op, std::span<const uint32_t> v) {
    const auto asSigned = [](uint32_t x) { return int32_t(x); };
    if (v.size() == 1) {
        switch (op) {
        case OpNot:
            return ~v[0];
        case OpSNegate:
            return 0u - v[0];
        case OpLogicalNot:
            return v[0] == 0 ? 1u : 0u;
        case OpBitcast:
        case OpCopyObject:
            return v[0];
        default:
            return {};
        }
    }
    if (v.size() == 3)
        return op == OpSelect ? std::optional(v[0] != 0 ? v[1] : v[2]) : std::nullopt;
    if (v.size() != 2) return {};
    const uint32_t a = v[0], b = v[1];
    switch (op) {
    case OpIAdd:
        return a + b;
    case OpISub:
        return a - b;
    case OpIMul:
        return a * b;
    case OpUDiv:
        return b != 0 ? std::optional(a / b) : std::nullopt;
    case OpUMod:
        return b != 0 ? std::optional(a % b) : std::nullopt;
    case OpShiftRightLogical:
        return b < 32 ? std::optional(a >> b) : std::nullopt;
    case OpShiftRightArithmetic:
        return b < 32 ? std::optional(uint32_t(asSigned(a) >> b)) : std::nullopt;
    case OpShiftLeftLogical:
        return b < 32 ? std::optional(a << b) : std::nullopt;
    case OpBitwiseOr:
        return a | b;
    case OpBitwiseXor:
        return a ^ b;
    case OpBitwiseAnd:
        return a & b;
    case OpLogicalEqual:
    case OpIEqual:
        return a == b;
    case OpLogicalNotEqual:
    case OpINotEqual:
        return a != b;
    case OpLogicalOr:
        return a | b;
    case OpLogicalAnd:
        return a & b;
    case OpUGreaterThan:
        return a > b;
    case OpUGreaterThanEqual:
        return a >= b;
    case OpULessThan:
        return a < b;
    case OpULessThanEqual:
        return a <= b;
    case OpSGreaterThan:
        return asSigned(a) > asSigned(b);
    case OpSGreaterThanEqual:
        return asSigned(a) >= asSigned(b);
    case OpSLessThan:
        return asSigned(a) < asSigned(b);
    case OpSLessThanEqual:
        return asSigned(a) <= asSigned(b);
    default:
        return {};
    }
}

/// Whether an instruction may be such an operation.
bool isComputed(uint16_t op) {
    return op == OpBitcast || op == OpCopyObject || op == OpSNegate || op == OpNot ||
           (OpIAdd <= op && op <= OpUMod) || (OpLogicalEqual <= op && op <= OpSLessThanEqual) ||
           (OpShiftRightLogical <= op && op <= OpBitwiseAnd);
}

// --- Folding -------------------------------------------------------------------------------------

enum class Kind : uint8_t { Other, Bool, Int32 };

/// Values of 32-bit integers and booleans by number, and what each number has been replaced by.
class Values {
  public:
    explicit Values(Module& module)
        : module_(module), replacedBy_(module.bound), known_(module.bound) {
        for (Instruction& i : module_.globals)
            enter(i);
    }

    /// Takes in a type or a constant; one that equals an earlier one is replaced by it.
    void enter(const Instruction& i) {
        if (i.op == OpTypeBool) kinds_[i.result] = Kind::Bool;
        if (i.op == OpTypeInt && module_.operands(i)[0] == 32) kinds_[i.result] = Kind::Int32;
        if (i.op == OpConstantTrue || i.op == OpConstantFalse)
            enter(i, i.op == OpConstantTrue ? 1u : 0u);
        if (i.op == OpConstant && kindOf(i.type) == Kind::Int32) enter(i, module_.operands(i)[0]);
    }

    Kind kindOf(uint32_t type) const {
        const auto found = kinds_.find(type);
        return found == kinds_.end() ? Kind::Other : found->second;
    }

    uint32_t resolve(uint32_t number) const {
        while (number < replacedBy_.size() && replacedBy_[number] != 0)
            number = replacedBy_[number];
        return number;
    }

    std::optional<uint32_t> valueOf(uint32_t number) const {
        if (number >= known_.size() || !known_[number].isKnown) return {};
        return known_[number].value;
    }

    void replace(uint32_t number, uint32_t by) {
        grow(number);
        if (number != by) replacedBy_[number] = by;
    }

    /// The number of a constant, which is made where there is none.
    uint32_t constant(uint32_t type, uint32_t value) {
        if (const auto found = constants_.find({type, value}); found != constants_.end())
            return found->second;
        const uint32_t number = module_.newNumber();
        Instruction i =
            kindOf(type) == Kind::Bool
                ? module_.make(value != 0 ? OpConstantTrue : OpConstantFalse, type, number, {})
                : module_.make(OpConstant, type, number, {&value, 1});
        module_.globals.push_back(i);
        enter(i, value);
        return number;
    }

  private:
    struct Known {
        bool isKnown = false;
        uint32_t value = 0;
    };

    void grow(uint32_t number) {
        if (number >= known_.size()) {
            known_.resize(module_.bound);
            replacedBy_.resize(module_.bound);
        }
    }

    void enter(const Instruction& i, uint32_t value) {
        grow(i.result);
        known_[i.result] = {true, value};
        const auto [at, isNew] = constants_.insert({{i.type, value}, i.result});
        if (!isNew) replace(i.result, at->second);
    }

    Module& module_;
    std::unordered_map<uint32_t, Kind> kinds_;
    std::vector<uint32_t> replacedBy_; ///< 0: by nothing
    std::vector<Known> known_;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> constants_;
};

/// Computes an operation whose operands are all known.
std::optional<uint32_t> computed(const Values& values, uint16_t op, uint32_t type,
                                 std::span<const uint32_t> operands) {
    if (!isComputed(op) || values.kindOf(type) == Kind::Other || operands.size() > 3) return {};
    uint32_t known[3] = {};
    for (size_t k = 0; k < operands.size(); ++k) {
        const auto value = values.valueOf(operands[k]);
        if (!value) return {};
        known[k] = *value;
    }
    return evaluate(op, {known, operands.size()});
}

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
