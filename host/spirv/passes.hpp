#pragma once

#include "host/spirv/module.hpp"

#include <span>

namespace stromboli::spirv {

/// Makes specialisation constants constants, and computes those that follow from them.
void setConstants(Module& module, std::span<const uint32_t> constants);

/// Computes the integers and booleans that constants alone decide, and puts values in the place of
/// what is always equal to them. Returns whether anything changed.
bool fold(Module& module);

/// Goes straight on where a branch is decided, and drops blocks that cannot be reached, selections
/// of nothing and boundaries of blocks that nobody else enters. Returns whether anything changed.
bool simplifyControlFlow(Module& module);

/// Drops what nobody reads: values, stores to variables that are never loaded, and these variables.
void dropDeadCode(Module& module);

/// Makes variables of the members of structures that are only used member by member or copied as a
/// whole. Returns whether there were any.
bool splitStructures(Module& module);

} // namespace stromboli::spirv
