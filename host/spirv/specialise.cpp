#include "host/spirv/specialise.hpp"

#include "host/spirv/passes.hpp"

namespace stromboli::spirv {
namespace {

void simplify(Module& module) {
    // Each round may decide more branches; a few are enough for all modules, and none has to be the
    // last.
    constexpr int kMostRounds = 12;
    for (int round = 0; round < kMostRounds; ++round) {
        const bool folded = fold(module);
        if (!simplifyControlFlow(module) && !folded) return;
    }
}

bool hasOneEntryPoint(const Module& module) {
    int entries = 0;
    for (const Instruction& i : module.preamble)
        entries += i.op == OpEntryPoint;
    return entries == 1;
}

} // namespace

std::optional<std::vector<uint32_t>> specialise(std::span<const uint32_t> code,
                                                std::span<const uint32_t> constants) {
    std::optional<Module> module = readModule(code);
    if (!module || !hasOneEntryPoint(*module)) return {};
    setConstants(*module, constants);
    fold(*module);
    simplifyControlFlow(*module);
    dropDeadCode(*module);
    // Most of a kernel is gone now. Written and read once more, the rest has small numbers, and all
    // that follows takes a time in proportion to the rest.
    module = readModule(writeModule(*module));
    if (!module) return {};
    simplify(*module);
    dropDeadCode(*module);
    while (splitStructures(*module)) {
        simplify(*module);
        dropDeadCode(*module);
    }
    simplify(*module);
    return writeModule(*module);
}

} // namespace stromboli::spirv
