#pragma once

namespace stromboli::vulkan {

/// Has lavapipe run 16 lanes at a time on processors with AVX-512, where Mesa (22.3 at least) takes
/// 8 unless the environment variable LP_NATIVE_VECTOR_WIDTH asks for more. If the user has set
/// that, nothing is done. No other driver reads it. The variable is set for this process, so it has
/// to be done before the first Instance, and while there is one thread only.
void useWideVectors();

} // namespace stromboli::vulkan
