#include "host/kernel/light_tree.hpp"

#include "host/core/color.hpp"
#include "host/kernel/gpu_scene.hpp"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>

namespace stromboli {

// --- Bounds of lights ----------------------------------------------------------------------------

namespace {

void encloses(LightBounds& bounds, std::initializer_list<glm::dvec3> points) {
    bounds.lo = glm::dvec3(1e300);
    bounds.hi = glm::dvec3(-1e300);
    for (const glm::dvec3& p : points) {
        bounds.lo = glm::min(bounds.lo, p);
        bounds.hi = glm::max(bounds.hi, p);
    }
}

/// A planar light with this normal, whose length is the light's area times a factor.
LightBounds planar(const Material& material, const glm::dvec3& emission, const glm::dvec3& normal,
                   double area) {
    LightBounds bounds;
    const double length = glm::length(normal);
    if (length > 0) {
        bounds.axis = normal / length;
        bounds.cosSpread = 1;
    }
    bounds.bothSides = material.emitsBothSides;
    bounds.power = luminance(emission) * area;
    return bounds;
}

} // namespace

LightBounds boundsOfTriangle(const Scene& scene, uint32_t index, const MeanEmission& means) {
    const Triangle& t = scene.triangles[index];
    const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                     c = scene.positions[t.corner[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    LightBounds bounds = planar(scene.materials[t.material], means.ofTriangle(index), normal,
                                0.5 * glm::length(normal));
    encloses(bounds, {a, b, c});
    return bounds;
}

LightBounds boundsOfEmitter(const Scene& scene, const Emitter& e, const MeanEmission& means) {
    const Material& material = scene.materials[e.material];
    if (e.kind == EmitterKind::Quad) {
        const glm::dvec3 a(e.edgeA), b(e.edgeB), corner(e.corner);
        const glm::dvec3 normal = glm::cross(a, b);
        LightBounds bounds = planar(material, material.emission, normal, glm::length(normal));
        encloses(bounds, {corner, corner + a, corner + b, corner + a + b});
        return bounds;
    }
    const Sphere& sphere = scene.spheres[e.sphere];
    const double radius = sphere.radius;
    LightBounds bounds;
    bounds.lo = bounds.hi = glm::dvec3(sphere.center);
    bounds.reach = radius;
    bounds.power = luminance(means.ofSphere(e.sphere)) * glm::pi<double>() * radius * radius;
    return bounds;
}

LightBounds boundsOfEnvironment(double luminance) {
    LightBounds bounds;
    bounds.group = gpu::LIGHT_GROUP_INFINITE;
    bounds.axis = {0, -1, 0};
    bounds.cosSpread = -1;
    // A surface that may face anywhere sees a quarter of it: the mean of its cosine.
    bounds.power = luminance / 4;
    return bounds;
}

// --- The tree ------------------------------------------------------------------------------------

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

/// How many of a complete tree's leaves, the nodes n to 2 n - 1, lie below a node.
uint32_t leavesBelow(uint32_t node, uint32_t n) {
    uint32_t leaves = 0;
    for (uint64_t first = node, last = node; first < 2 * uint64_t(n); first *= 2) {
        if (last >= n)
            leaves += uint32_t(std::min<uint64_t>(last, 2 * uint64_t(n) - 1) + 1 -
                               std::max<uint64_t>(first, n));
        last = 2 * std::min<uint64_t>(last, n - 1) + 1;
    }
    return leaves;
}

/// The upper half of a float of at least this value, and finite.
uint32_t halfRoundedUp(double value) {
    constexpr uint32_t kLeast = 0x0080, kMost = 0x7F7F; // 2^-126 and the largest
    float up = float(std::min(value, 3e38));
    if (up < value) up = std::nextafter(up, INFINITY);
    return std::clamp((std::bit_cast<uint32_t>(up) + 0xFFFF) >> 16, value > 0 ? kLeast : 0, kMost);
}

/// The tree of one group.
class TreeBuilder {
  public:
    using Numbers = std::span<uint32_t>;

    /// numbers: of the group's lights in `lights`; they are put into the order of the leaves.
    TreeBuilder(std::span<const LightBounds> lights, Numbers numbers, LightTree& tree)
        : lights_(lights), count_(uint32_t(numbers.size())),
          firstNode_(uint32_t(tree.nodes.size())), firstLight_(uint32_t(tree.order.size())),
          tree_(tree) {
        tree_.nodes.resize(firstNode_ + 2 * size_t(count_));
        tree_.order.resize(firstLight_ + size_t(count_));
        tree_.trails.resize(tree_.order.size());
        build(numbers, 1, 0, 0);
    }

  private:
    void build(Numbers numbers, uint32_t node, uint32_t level, uint32_t trail) {
        tree_.nodes[firstNode_ + node] = boundsOf(numbers);
        tree_.levels = std::max(tree_.levels, level);
        if (node >= count_) {
            const uint32_t light = firstLight_ + node - count_;
            tree_.order[light] = numbers[0];
            tree_.trails[light] = trail;
            return;
        }
        const size_t left = leavesBelow(2 * node, count_);
        sortAlong(numbers, left, bestAxis(numbers, left));
        build(numbers.first(left), 2 * node, level + 1, trail);
        build(numbers.subspan(left), 2 * node + 1, level + 1, trail | 1u << level);
    }

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

    /// The `left` lowest along the axis come first.
    void sortAlong(Numbers numbers, size_t left, int axis) const {
        std::nth_element(numbers.begin(), numbers.begin() + long(left), numbers.end(),
                         [&](uint32_t a, uint32_t b) {
                             const double x = centroid(a)[axis], y = centroid(b)[axis];
                             return x != y ? x < y : a < b;
                         });
    }

    int bestAxis(Numbers numbers, size_t left) const {
        int best = 0;
        double least = INFINITY;
        for (int axis = 0; axis < 3; ++axis) {
            sortAlong(numbers, left, axis);
            const double sum = cost(numbers.first(left)) + cost(numbers.subspan(left));
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
        node.radiusAndPower =
            halfRoundedUp(radius * (1 + 0x1p-20)) << 16 | halfRoundedUp(powerOf(numbers));
        node.axis = encodeNormal(glm::vec3(coneOf(numbers).axis));
        const glm::dvec3 axis = decodeNormal(node.axis);
        double cosine = 1;
        for (uint32_t n : numbers)
            cosine = std::min(cosine, cosineFrom(axis, light(n)));
        node.cosSpread = float(std::max(cosine - 0x1p-20, -1.0));
        node.flags =
            (bothSides ? gpu::LIGHT_NODE_BOTH_SIDES : 0) | (sharp ? gpu::LIGHT_NODE_SHARP : 0);
        return node;
    }

    std::span<const LightBounds> lights_;
    uint32_t count_, firstNode_, firstLight_;
    LightTree& tree_;
};

} // namespace

void setPowers(std::span<gpu::LightNode> nodes, std::span<const uint32_t> lightsInGroup,
               std::span<const LightBounds> lights, std::span<const double> factors) {
    size_t first = 0;
    for (const uint32_t count : lightsInGroup) {
        std::vector<double> power(2 * size_t(count));
        for (size_t node = power.size(); node-- > 1;) {
            const size_t light = first + node - count;
            power[node] = node >= count ? lights[light].power * factors[light]
                                        : power[2 * node] + power[2 * node + 1];
            uint32_t& stored = nodes[2 * first + node].radiusAndPower;
            stored = (stored & 0xFFFF0000u) | halfRoundedUp(power[node]);
        }
        first += count;
    }
}

LightTree buildLightTree(std::span<const LightBounds> lights) {
    LightTree tree;
    for (uint32_t group = 0; group < gpu::LIGHT_GROUP_COUNT; ++group) {
        std::vector<uint32_t> numbers;
        for (uint32_t i = 0; i < lights.size(); ++i)
            if (lights[i].group == group) numbers.push_back(i);
        if (numbers.empty()) continue;
        tree.groups |= 1u << group;
        tree.lightsInGroup[group] = uint32_t(numbers.size());
        TreeBuilder(lights, numbers, tree);
    }
    return tree;
}

} // namespace stromboli
