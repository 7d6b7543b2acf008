// Arithmetic of constants.
#include "host/spirv/values.hpp"

namespace stromboli::spirv {
namespace {

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

} // namespace

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

} // namespace stromboli::spirv
