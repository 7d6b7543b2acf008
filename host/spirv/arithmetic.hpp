#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace stromboli::spirv {

/// The result of an operation on 32-bit integers or booleans (0 or 1), by the words of its one to
/// three operands; nothing if it is undefined or not computed here. The operation has to be one
/// that isComputed().
std::optional<uint32_t> evaluate(uint16_t op, std::span<const uint32_t> v);

/// Whether an instruction may be such an operation.
bool isComputed(uint16_t op);

} // namespace stromboli::spirv
