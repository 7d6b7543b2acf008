#include "host/spirv/specialise.hpp"

#include "host/spirv/module.hpp"

namespace stromboli::spirv {
namespace {

/// Folds and goes straight on until nothing changes. No pass has to be the last one for the module
/// to be right, so the number of rounds is limited, whatever a module holds.
constexpr int kMostRounds = 12;

void simplify(Module& module) {
    for (int round = 0; round < kMostRounds; ++round) {
        const bool folded = fold(module);
        if (!simplifyControlFlow(module) && !folded) return;
    }
}

size_t instructionsOf(const Module& module) {
    size_t count = module.globals.size();
    for (const Function& f : module.functions)
        for (const Block& b : f.blocks)
            count += 1 + b.body.size();
    return count;
}

/// Selections may be empty once what they held is dropped, and their conditions are then read by
/// nobody.
void settle(Module& module) {
    size_t before = 0;
    for (int round = 0; round < kMostRounds && before != instructionsOf(module); ++round) {
        before = instructionsOf(module);
        simplify(module);
        dropDeadCode(module);
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
    do
        settle(*module);
    while (splitStructures(*module));
    // Each of them leaves fewer switches, loops or loads, so that this ends. Loops are unrolled
    // once nothing leaves them through a switch, and values forwarded once counters are constants.
    while (dissolveSwitches(*module) || unrollLoops(*module) || forwardValues(*module))
        settle(*module);
    return writeModule(*module);
}

} // namespace stromboli::spirv
