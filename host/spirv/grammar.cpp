#include "host/spirv/grammar.hpp"

namespace stromboli::spirv {

const char* grammarOf(uint16_t op) {
    switch (op) {
    case OpUndef:
        return "tr";
    case OpExtension:
    case OpCapability:
    case OpMemoryModel:
        return "L";
    case OpExtInstImport:
        return "rL";
    case OpExtInst:
        return "trilI";
    case OpEntryPoint:
        return "L"; // its interface is taken apart by the writer
    case OpExecutionMode:
        return "iL";
    case OpTypeVoid:
    case OpTypeBool:
        return "r";
    case OpTypeInt:
    case OpTypeFloat:
        return "rL";
    case OpTypeVector:
    case OpTypeMatrix:
        return "ril";
    case OpTypeImage:
        return "riL";
    case OpTypeArray:
        return "rii";
    case OpTypeRuntimeArray:
        return "ri";
    case OpTypeStruct:
    case OpTypeFunction:
        return "rI";
    case OpTypePointer:
        return "rli";
    case OpConstantTrue:
    case OpConstantFalse:
    case OpConstantNull:
        return "tr";
    case OpSpecConstantTrue:
    case OpSpecConstantFalse:
        return "tr";
    case OpConstant:
    case OpSpecConstant:
        return "trL";
    case OpConstantComposite:
    case OpSpecConstantComposite:
        return "trI";
    case OpSpecConstantOp:
        return "trlI";
    case OpFunction:
        return "trli";
    case OpFunctionParameter:
        return "tr";
    case OpFunctionEnd:
        return "";
    case OpFunctionCall:
        return "trI";
    case OpVariable:
        return "trlI";
    case OpImageTexelPointer:
        return "triii";
    case OpLoad:
        return "triL";
    case OpStore:
        return "iiL";
    case OpCopyMemory:
        return "iiL";
    case OpAccessChain:
    case OpInBoundsAccessChain:
        return "trI";
    case OpArrayLength:
        return "tril";
    case OpVectorShuffle:
        return "triiL";
    case OpCompositeConstruct:
        return "trI";
    case OpCompositeExtract:
        return "triL";
    case OpCompositeInsert:
        return "triiL";
    case OpImageRead:
        return "triiM";
    case OpImageWrite:
        return "iiiM";
    case OpControlBarrier:
        return "iii";
    case OpMemoryBarrier:
        return "ii";
    case OpAtomicStore:
        return "iiii";
    case OpPhi:
        return "trI";
    case OpLoopMerge:
        return "iil";
    case OpSelectionMerge:
        return "il";
    case OpLabel:
        return "r";
    case OpBranch:
        return "i";
    case OpBranchConditional:
        return "iiiL";
    case OpSwitch:
        return "iiW";
    case OpKill:
    case OpReturn:
    case OpUnreachable:
        return "";
    case OpReturnValue:
        return "i";
    default:
        break;
    }
    const auto within = [op](uint16_t first, uint16_t last) { return first <= op && op <= last; };
    if (op == 77 || op == 78 || op == 83 || op == 84)
        return "trI";                                    // dynamic vectors, CopyObject, Transpose
    if (within(109, 124) && op != 121) return "trI";     // conversions
    if (within(126, 152)) return "trI";                  // arithmetic
    if (within(154, 191)) return "trI";                  // logic and comparisons
    if (within(194, 205)) return "trI";                  // bits
    if (within(207, 215)) return "trI";                  // derivatives
    if (within(OpAtomicLoad, OpAtomicXor)) return "trI"; // scopes and semantics are numbers
    if (within(333, 341) || within(343, 348)) return "trI"; // votes, ballots, shuffles
    if (op == 342 || within(349, 364)) return "trilI";      // subgroup operations with a kind
    return nullptr;
}

bool hasEffect(uint16_t op) {
    return op == OpFunctionCall || op == OpCopyMemory || op == OpImageWrite ||
           op == OpControlBarrier || op == OpMemoryBarrier ||
           (OpAtomicLoad <= op && op <= OpAtomicXor) || op == OpSelectionMerge ||
           op == OpLoopMerge || endsBlock(op);
}

bool endsBlock(uint16_t op) {
    return OpBranch <= op && op <= OpUnreachable;
}

} // namespace stromboli::spirv
