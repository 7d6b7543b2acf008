#pragma once

#include "host/bench/embree_kernel_spherical.hpp"
#include "host/bench/embree_kernel_surface.hpp"

// The walk down a light tree: shaders/include/light_tree.glsl, where the reasons are.
namespace stromboli::bench::native {
namespace {

inline SineCosine lessAngle(SineCosine a, SineCosine b) {
    if (a.cosine >= b.cosine) return {0, 1};
    return {a.sine * b.cosine - a.cosine * b.sine, a.cosine * b.cosine + a.sine * b.sine};
}

inline SineCosine angleOfCosine(float c) {
    return {std::sqrt(larger(1 - c * c, 0.0f)), c};
}

inline float likelyLight(const LightNode& node, const Point& p) {
    const Vec d = vec(node.center) - p.position;
    const float distance2 = dot(d, d), radius2 = node.radius * node.radius;
    const Vec w = d * (1 / std::sqrt(larger(distance2, kTiny)));
    const float sin2Bound = smaller(radius2 / larger(distance2, kTiny), 1.0f);
    const SineCosine bound{std::sqrt(sin2Bound), std::sqrt(1 - sin2Bound)};
    const float towards = -dot(vec(node.axis), w);
    const SineCosine lamp =
        lessAngle(lessAngle(angleOfCosine(node.bothSides ? std::fabs(towards) : towards),
                            angleOfCosine(node.cosSpread)),
                  bound);
    const SineCosine surface = lessAngle(angleOfCosine(dot(p.shading, w)), bound);
    const float cosines =
        distance2 > radius2 ? larger(lamp.cosine, 0.0f) * larger(surface.cosine, 0.0f) : 1.0f;
    return node.power * cosines / larger(larger(distance2, radius2), kTiny);
}

struct PickedLeaf {
    const LightNode* node;
    float probability, u;
};

inline PickedLeaf walkLightTree(const LightNode* nodes, const Point& p, float u, float second) {
    const LightNode* node = nodes;
    float probability = 1;
    for (int level = 0; node->count == 0; ++level) {
        const LightNode *a = nodes + node->child, *b = a + 1;
        const float ofA = likelyLight(*a, p), sum = ofA + likelyLight(*b, p);
        const float share = sum > 0 ? ofA / sum : 0.5f;
        if (!(sum > 0)) probability = 0;
        if (level == 10) u = second;
        const bool first = u < share;
        node = first ? a : b;
        probability *= first ? share : 1 - share;
        u = smaller(first ? u / share : (u - share) / (1 - share), 1 - kRoundoff);
    }
    return {node, probability, u};
}

} // namespace
} // namespace stromboli::bench::native
