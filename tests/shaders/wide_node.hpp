#pragma once

#include "host/core/random.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace stromboli::test {

struct DoubleBox {
    glm::dvec3 low{0.0}, high{0.0};
};

/// A gpu::NodeRecord in parts, packed as its comment says and by nothing else.
class WideNode {
  public:
    /// Cells of 2^cellExponent on each axis; the origin is rounded down to what a word holds.
    WideNode(const glm::vec3& origin, const std::array<int, 3>& cellExponents);

    /// The child's box is planes low to high of each axis.
    void addChild(uint32_t slot, const glm::uvec3& low, const glm::uvec3& high);

    bool has(uint32_t slot) const { return (present_ >> slot & 1) != 0; }
    uint32_t present() const { return present_; } ///< bit (slot)
    glm::dvec3 origin() const;
    glm::dvec3 cell() const;
    /// The planes of a child's box, moved inwards by this many cells.
    DoubleBox box(uint32_t slot, double inwards) const;
    std::array<uint32_t, 16> words() const;

  private:
    std::array<uint32_t, 3> originAndExponent_;
    std::array<std::array<uint8_t, 3>, 8> low_, high_;
    uint32_t present_ = 0;
};

/// A node of about this size, `shift` times its size away from the coordinates' origin, with some
/// of the slots in use; one axis in five is a cell thin for all children.
WideNode randomNode(float size, float shift, Random& random);

} // namespace stromboli::test
