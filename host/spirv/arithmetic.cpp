#include "host/spirv/arithmetic.hpp"

#include "host/spirv/grammar.hpp"

namespace stromboli::spirv {

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

bool isComputed(uint16_t op) {
    return op == OpBitcast || op == OpCopyObject || op == OpSNegate || op == OpNot ||
           (OpIAdd <= op && op <= OpUMod) || (OpLogicalEqual <= op && op <= OpSLessThanEqual) ||
           (OpShiftRightLogical <= op && op <= OpBitwiseAnd);
}

} // namespace stromboli::spirv
