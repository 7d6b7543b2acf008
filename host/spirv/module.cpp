#include "host/spirv/module.hpp"

namespace stromboli::spirv {
namespace {

constexpr uint32_t kMagic = 0x07230203, kHeaderWords = 5;

bool isForDebuggers(uint16_t op) {
    return (OpSource - 1 <= op && op <= OpLine) || op == OpNoLine || op == OpModuleProcessed;
}

bool isPreamble(uint16_t op) {
    return op == OpCapability || op == OpExtension || op == OpExtInstImport ||
           op == OpMemoryModel || op == OpEntryPoint || op == OpExecutionMode;
}

/// Puts an instruction into the part of the module that it belongs to; false: it cannot stand here.
bool place(Module& module, const Instruction& i, bool& inFunction) {
    if (i.op == OpFunction) {
        if (inFunction) return false;
        module.functions.push_back({.head = i});
        inFunction = true;
    } else if (i.op == OpFunctionEnd) {
        if (!inFunction) return false;
        inFunction = false;
    } else if (inFunction) {
        Function& f = module.functions.back();
        if (i.op == OpLabel)
            f.blocks.push_back({.label = i.result});
        else if (i.op == OpFunctionParameter)
            f.parameters.push_back(i);
        else if (f.blocks.empty())
            return false;
        else
            f.blocks.back().body.push_back(i);
    } else if (isPreamble(i.op)) {
        module.preamble.push_back(i);
    } else if (i.op == OpDecorate || i.op == OpMemberDecorate) {
        module.decorations.push_back(i);
    } else {
        module.globals.push_back(i);
    }
    return true;
}

} // namespace

Instruction Module::make(uint16_t op, uint32_t type, uint32_t result,
                         std::span<const uint32_t> operands) {
    const Instruction i = {op, uint16_t(operands.size()), uint32_t(words.size()), type, result};
    words.insert(words.end(), operands.begin(), operands.end());
    return i;
}

std::optional<Module> readModule(std::span<const uint32_t> code) {
    if (code.size() < kHeaderWords || code[0] != kMagic) return {};
    Module module{.version = code[1], .bound = code[3]};
    // Passes append the operands of what they make.
    module.words.reserve(code.size() + code.size() / 4);
    module.words.assign(code.begin(), code.end());
    bool inFunction = false;
    for (size_t at = kHeaderWords; at < code.size();) {
        const uint16_t op = uint16_t(code[at] & 0xFFFF), length = uint16_t(code[at] >> 16);
        if (length == 0 || length > code.size() - at) return {};
        const size_t end = at + length;
        if (!isForDebuggers(op)) {
            const bool decorates = op == OpDecorate || op == OpMemberDecorate;
            const char* grammar = decorates ? "iL" : grammarOf(op);
            if (grammar == nullptr) return {};
            Instruction i = {.op = op};
            size_t next = at + 1;
            if (*grammar == 't') {
                if (next >= end) return {};
                i.type = code[next++];
                ++grammar;
            }
            if (*grammar == 'r') {
                if (next >= end) return {};
                i.result = code[next++];
            }
            i.at = uint32_t(next);
            i.count = uint16_t(end - next);
            if (i.type >= module.bound || i.result >= module.bound) return {};
            if (!place(module, i, inFunction)) return {};
        }
        at = end;
    }
    for (const Function& f : module.functions)
        for (const Block& b : f.blocks)
            if (b.body.empty() || !endsBlock(b.body.back().op)) return {};
    if (inFunction || module.functions.empty()) return {};
    return module;
}

} // namespace stromboli::spirv
