// Stands for the other embree files where Embree's headers were not found.
#include "host/bench/embree.hpp"

namespace stromboli::bench {

OpenedEmbree openEmbree(uint32_t) {
    return {nullptr, "the program was built without it; on Debian: apt install libembree-dev, "
                     "then build again"};
}

} // namespace stromboli::bench
