#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stromboli::test {

using Words = std::vector<uint32_t>;
using Code = std::span<const uint32_t>;

/// What spirv-val says of the module; empty: it is valid.
std::string complaint(const Words& code);

Words readWords(const std::string& file);

/// What spirv-opt makes of the module by these of its passes.
Words optimised(const Words& code, const std::string& passes);

/// The constants of the kernel of a scene of the library, with its usual settings.
Words featuresOf(const std::string& scene, bool everythingOn = false);

} // namespace stromboli::test
