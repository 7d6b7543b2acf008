#pragma once

#include "host/spirv/grammar.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

namespace stromboli::spirv {

// --- Modules -------------------------------------------------------------------------------------

/// An instruction; its operands, without result and type, lie in Module::words.
struct Instruction {
    uint16_t op = 0;
    uint16_t count = 0; ///< operands
    uint32_t at = 0;    ///< the first of them
    uint32_t type = 0;  ///< 0: none
    uint32_t result = 0;
};

/// Instructions that run one after the other; the last one says where it goes on. OpLabel is
/// `label`.
struct Block {
    uint32_t label = 0;
    std::vector<Instruction> body;
};

struct Function {
    Instruction head;
    std::vector<Instruction> parameters;
    std::vector<Block> blocks; ///< the first one is entered
};

/// A SPIR-V module taken apart, without what debuggers alone read.
struct Module {
    uint32_t version = 0;
    uint32_t bound = 0; ///< all numbers are less
    std::vector<uint32_t> words;
    std::vector<Instruction> preamble;    ///< capabilities to execution modes
    std::vector<Instruction> decorations; ///< operands: the target, then literals
    std::vector<Instruction> globals;     ///< types, constants, variables
    std::vector<Function> functions;

    std::span<uint32_t> operands(const Instruction& i) { return {words.data() + i.at, i.count}; }
    std::span<const uint32_t> operands(const Instruction& i) const {
        return {words.data() + i.at, i.count};
    }
    Instruction make(uint16_t op, uint32_t type, uint32_t result,
                     std::span<const uint32_t> operands);
    uint32_t newNumber() { return bound++; }
};

/// Nothing where an instruction is not known, or the module is not well-formed.
std::optional<Module> readModule(std::span<const uint32_t> code);

/// The module's words; numbers, types, constants and decorations in the order of first use.
std::vector<uint32_t> writeModule(const Module& module);

/// Calls `visit(word)` for each operand that is another instruction's number.
template <class Words, class Visit>
void forEachNumber(const Instruction& i, Words operands, Visit visit) {
    const char* letter = grammarOf(i.op);
    while (*letter == 't' || *letter == 'r')
        ++letter;
    for (size_t k = 0; k < operands.size(); ++k) {
        switch (*letter) {
        case 'i':
            visit(operands[k]);
            ++letter;
            break;
        case 'l':
            ++letter;
            break;
        case 'I':
            visit(operands[k]);
            break;
        case 'L':
            return;
        case 'W':
            if (++k < operands.size()) visit(operands[k]);
            break;
        case 'M':
            letter = "I";
            break;
        default:
            return;
        }
    }
}

// --- Passes --------------------------------------------------------------------------------------

/// Makes specialisation constants constants, and computes those that follow from them.
void setConstants(Module& module, std::span<const uint32_t> constants);

/// Computes the integers and booleans that constants alone decide, and puts values in the place of
/// what is always equal to them. Returns whether anything changed.
bool fold(Module& module);

/// Goes straight on where a branch is decided, and drops blocks that cannot be reached, selections
/// of nothing and boundaries of blocks that nobody else enters. Returns whether anything changed.
bool simplifyControlFlow(Module& module);

/// Makes nested selections of the switches of a single case that early returns become, which
/// drivers would make loops of. Returns whether there were any.
bool dissolveSwitches(Module& module);

/// Unrolls short loops that go by a constant number of times. Returns whether there were any.
bool unrollLoops(Module& module);

/// Puts what was stored in the place of loads of a function's variables, where that is the same on
/// every way to them. Returns whether there were any.
bool forwardValues(Module& module);

/// Drops what nobody reads: values, stores to variables that are never loaded, and these variables.
void dropDeadCode(Module& module);

/// Makes variables of the members of structures that are only used member by member or copied as a
/// whole. Returns whether there were any.
bool splitStructures(Module& module);

} // namespace stromboli::spirv
