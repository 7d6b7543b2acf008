#include "host/kernel/light_tree.hpp"

#include "host/kernel/gpu_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stromboli {
namespace {

/// All normals lie within this cone, which is not the smallest.
struct NormalCone {
    glm::dvec3 axis{0, 0, 1};
    double cosine = -1; ///< of its half angle
};

/// Cosine of the largest angle to `axis` in the light's own cone.
double cosineFrom(const glm::dvec3& axis, const LightBounds& light) {
    const double between = std::clamp(glm::dot(axis, light.axis), -1.0, 1.0);
    if (light.cosSpread >= 1) return between;
    const double angle = std::acos(between) + std::acos(std::clamp(light.cosSpread, -1.0, 1.0));
    return angle >= std::acos(-1.0) ? -1.0 : std::cos(angle);
}

class TreeBuilder {
  public:
    TreeBuilder(std::span<const LightBounds> lights, LightTree& tree)
        : lights_(lights), tree_(tree) {}

    using Numbers = std::span<uint32_t>;

    /// Fills in node `index`, which exists.
    void build(Numbers numbers, uint32_t index, uint32_t level, uint32_t trail) {
        gpu::LightNode node = boundsOf(numbers);
        tree_.levels = std::max(tree_.levels, level);
        if (numbers.size() == 1) {
            node.child |= gpu::LIGHT_NODE_IS_LEAF | numbers[0];
            tree_.nodes[index] = node;
            tree_.trails[numbers[0]] = trail;
            return;
        }
        sortAlong(numbers, bestAxis(numbers));
        const auto children = uint32_t(tree_.nodes.size());
        tree_.nodes.resize(children + 2);
        node.child |= children;
        tree_.nodes[index] = node;
        const size_t half = numbers.size() / 2;
        build(numbers.first(half), children, level + 1, trail);
        build(numbers.subspan(half), children + 1, level + 1, trail | 1u << level);
    }

  private:
    const LightBounds& light(uint32_t number) const { return lights_[number]; }

    glm::dvec3 centroid(uint32_t number) const {
        // Infinite lights have no place; they are sorted by where they shine from.
        if (light(number).group == gpu::LIGHT_GROUP_INFINITE) return light(number).axis;
        return 0.5 * (light(number).lo + light(number).hi);
    }

    NormalCone coneOf(Numbers numbers) const {
        glm::dvec3 sum(0.0);
        for (uint32_t n : numbers)
            sum += light(n).power * light(n).axis;
        const double length = glm::length(sum);
        NormalCone cone;
        if (!(length > 0)) return cone;
        cone.axis = sum / length;
        cone.cosine = 1;
        for (uint32_t n : numbers)
            cone.cosine = std::min(cone.cosine, cosineFrom(cone.axis, light(n)));
        return cone;
    }

    double powerOf(Numbers numbers) const {
        double sum = 0;
        for (uint32_t n : numbers)
            sum += light(n).power;
        return sum;
    }

    /// What the surface area heuristic of Conty Estevez and Kulla (equation 1) makes of a half;
    /// their measure of orientation with emission over a hemisphere, as a function of the cosine,
    /// is close to 2 - cosine.
    double cost(Numbers numbers) const {
        glm::dvec3 lo(1e300), hi(-1e300);
        for (uint32_t n : numbers) {
            lo = glm::min(lo, light(n).lo - light(n).reach);
            hi = glm::max(hi, light(n).hi + light(n).reach);
        }
        const glm::dvec3 e = hi - lo;
        return powerOf(numbers) * (e.x * e.y + e.y * e.z + e.z * e.x) *
               (2 - coneOf(numbers).cosine);
    }

    void sortAlong(Numbers numbers, int axis) const {
        std::nth_element(numbers.begin(), numbers.begin() + long(numbers.size() / 2), numbers.end(),
                         [&](uint32_t a, uint32_t b) {
                             const double x = centroid(a)[axis], y = centroid(b)[axis];
                             return x != y ? x < y : a < b;
                         });
    }

    int bestAxis(Numbers numbers) const {
        int best = 0;
        double least = INFINITY;
        for (int axis = 0; axis < 3; ++axis) {
            sortAlong(numbers, axis);
            const size_t half = numbers.size() / 2;
            const double sum = cost(numbers.first(half)) + cost(numbers.subspan(half));
            if (sum < least) least = sum, best = axis;
        }
        return best;
    }

    /// Rounded outwards: the sphere by 2^-20 of its radius, for the rounding of distances to it in
    /// the shader; the cone, about the axis as it is stored, by 2^-20 for that of cosines.
    gpu::LightNode boundsOf(Numbers numbers) const {
        gpu::LightNode node{};
        glm::dvec3 lo(1e300), hi(-1e300);
        bool bothSides = false, sharp = true;
        for (uint32_t n : numbers) {
            lo = glm::min(lo, light(n).lo);
            hi = glm::max(hi, light(n).hi);
            bothSides |= light(n).bothSides;
            sharp &= light(n).sharp;
        }
        node.center = glm::vec3(0.5 * (lo + hi));
        double radius = 0;
        for (uint32_t n : numbers) {
            const glm::dvec3 center(node.center);
            const glm::dvec3 farthest =
                glm::max(glm::abs(light(n).lo - center), glm::abs(light(n).hi - center));
            radius = std::max(radius, glm::length(farthest) + light(n).reach);
        }
        node.radius = float(radius * (1 + 0x1p-20));
        node.axis = encodeNormal(glm::vec3(coneOf(numbers).axis));
        const glm::dvec3 axis = decodeNormal(node.axis);
        double cosine = 1;
        for (uint32_t n : numbers)
            cosine = std::min(cosine, cosineFrom(axis, light(n)));
        node.cosSpread = float(std::max(cosine - 0x1p-20, -1.0));
        node.power = float(powerOf(numbers));
        node.child =
            (bothSides ? gpu::LIGHT_NODE_BOTH_SIDES : 0) | (sharp ? gpu::LIGHT_NODE_SHARP : 0);
        return node;
    }

    std::span<const LightBounds> lights_;
    LightTree& tree_;
};

gpu::LightNode emptyNode() {
    gpu::LightNode node{};
    node.child = gpu::LIGHT_NODE_IS_LEAF;
    return node;
}

} // namespace

LightTree buildLightTree(std::span<const LightBounds> lights) {
    LightTree tree;
    tree.nodes.assign(gpu::LIGHT_GROUP_COUNT, emptyNode());
    tree.trails.assign(lights.size(), 0);
    TreeBuilder builder(lights, tree);
    for (uint32_t group = 0; group < gpu::LIGHT_GROUP_COUNT; ++group) {
        std::vector<uint32_t> numbers;
        for (uint32_t i = 0; i < lights.size(); ++i)
            if (lights[i].group == group) numbers.push_back(i);
        if (numbers.empty()) continue;
        tree.groups |= 1u << group;
        builder.build(numbers, group, 0, 0);
    }
    return tree;
}

} // namespace stromboli
