#include "tests/shaders/wide_node.hpp"

#include <algorithm>
#include <bit>

namespace stromboli::test {
namespace {

constexpr uint32_t kOriginMask = 0xFFFFFF00u;
constexpr int kLeastCellExponent = -90; // what the host packs (host/bvh/node_record.hpp)

/// The largest float that is not above x and has nothing in its lowest byte.
uint32_t originWord(float x) {
    const auto word = std::bit_cast<uint32_t>(x);
    const bool cut = (word & ~kOriginMask) != 0;
    return (word & kOriginMask) + (cut && x < 0 ? 0x100u : 0u); // away from 0 below it
}

} // namespace

WideNode::WideNode(const glm::vec3& origin, const std::array<int, 3>& cellExponents) {
    for (int axis = 0; axis < 3; ++axis)
        originAndExponent_[axis] = originWord(origin[axis]) | uint32_t(cellExponents[axis] + 127);
    for (size_t slot = 0; slot < low_.size(); ++slot) {
        low_[slot].fill(255);
        high_[slot].fill(0);
    }
}

void WideNode::addChild(uint32_t slot, const glm::uvec3& low, const glm::uvec3& high) {
    for (int axis = 0; axis < 3; ++axis) {
        low_[slot][axis] = uint8_t(low[axis]);
        high_[slot][axis] = uint8_t(high[axis]);
    }
    present_ |= 1u << slot;
}

glm::dvec3 WideNode::origin() const {
    glm::dvec3 o;
    for (int axis = 0; axis < 3; ++axis)
        o[axis] = std::bit_cast<float>(originAndExponent_[axis] & kOriginMask);
    return o;
}

glm::dvec3 WideNode::cell() const {
    glm::dvec3 c;
    for (int axis = 0; axis < 3; ++axis)
        c[axis] = std::ldexp(1.0, int(originAndExponent_[axis] & 0xFFu) - 127);
    return c;
}

DoubleBox WideNode::box(uint32_t slot, double inwards) const {
    DoubleBox b;
    for (int axis = 0; axis < 3; ++axis) {
        b.low[axis] = origin()[axis] + (low_[slot][axis] + inwards) * cell()[axis];
        b.high[axis] = origin()[axis] + (high_[slot][axis] - inwards) * cell()[axis];
    }
    return b;
}

std::array<uint32_t, 16> WideNode::words() const {
    std::array<uint32_t, 16> w{};
    for (int axis = 0; axis < 3; ++axis)
        w[axis] = originAndExponent_[axis];
    w[3] = gpu::RECORD_IS_NODE | 1u;
    for (uint32_t slot = 0; slot < 8; ++slot)
        for (uint32_t axis = 0; axis < 3; ++axis) {
            const uint32_t shift = 8 * (slot % 4), row = 4 + 4 * axis + slot / 4;
            w[row] |= uint32_t(low_[slot][axis]) << shift;
            w[row + 2] |= uint32_t(high_[slot][axis]) << shift;
        }
    return w;
}

WideNode randomNode(float size, float shift, Random& random) {
    const glm::vec3 origin = size * (shift * random.inCube(1) - glm::vec3(0.5f));
    std::array<int, 3> exponents;
    std::array<bool, 3> thin;
    for (int axis = 0; axis < 3; ++axis) {
        const int full = int(std::ceil(std::log2(size / 255)));
        exponents[axis] = std::max(full - int(random.below(3)), kLeastCellExponent);
        thin[axis] = random.below(5) == 0;
    }
    WideNode node(origin, exponents);
    for (uint32_t slot = 0; slot < 8; ++slot) {
        if (random.below(3) == 0) continue;
        glm::uvec3 low, high;
        for (int axis = 0; axis < 3; ++axis) {
            const uint32_t a = random.below(255), b = random.below(255);
            low[axis] = thin[axis] ? 0 : std::min(a, b);
            high[axis] = thin[axis] ? 1 : std::max(a, b) + 1;
        }
        node.addChild(slot, low, high);
    }
    return node;
}

} // namespace stromboli::test
