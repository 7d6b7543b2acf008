#pragma once

#include "host/bench/embree_kernel_spherical.hpp"
#include "host/bench/embree_kernel_surface.hpp"
#include "shaders/shared/interface.h"
#include "shaders/shared/light_types.h"

// The choice of one of the lights: shaders/lights/light_tree.glsl and light_sampler.glsl, where the
// reasons are.
namespace stromboli::bench::native {
namespace {

inline SineCosine lessAngle(SineCosine a, SineCosine b) {
    if (a.cosine >= b.cosine) return {0, 1};
    return {a.sine * b.cosine - a.cosine * b.sine, a.cosine * b.cosine + a.sine * b.sine};
}

inline SineCosine angleOfCosine(float c) {
    return {std::sqrt(larger(1 - c * c, 0.0f)), c};
}

/// As the function of this name in shaders/lights/light_tree.glsl.
inline float likelyLightWithoutCone(const LightNode& node, const Point& p) {
    const Vec d = vec(node.center) - p.position;
    const float distance2 = dot(d, d), reach = dot(p.shading, d) + node.radius;
    if (!(reach > 0)) return 0;
    const float cube =
        (std::sqrt(distance2) + node.radius) * larger(distance2, node.radius * node.radius);
    return node.power * reach / smaller(larger(cube, kTiny), std::numeric_limits<float>::max());
}

inline float likelyLight(const LightNode& node, uint32_t group, const Point& p,
                         bool nearWithoutCones) {
    if (nearWithoutCones) return likelyLightWithoutCone(node, p);
    const Vec axis = vec(node.axis);
    const SineCosine spread{node.sinSpread, node.cosSpread};
    if (group == gpu::LIGHT_GROUP_INFINITE)
        return node.power *
               larger(lessAngle(angleOfCosine(-dot(p.shading, axis)), spread).cosine, 0.0f);
    const Vec d = vec(node.center) - p.position;
    const float distance2 = dot(d, d), radius2 = node.radius * node.radius;
    const float falloff =
        group == gpu::LIGHT_GROUP_NEAR ? larger(larger(distance2, radius2), kTiny) : 1.0f;
    if (distance2 <= radius2) return node.power / falloff;
    const Vec w = d * (1 / std::sqrt(larger(distance2, kTiny)));
    const float sin2Bound = smaller(radius2 / larger(distance2, kTiny), 1.0f);
    const SineCosine bound{std::sqrt(sin2Bound), std::sqrt(1 - sin2Bound)};
    float lightCosine = 1;
    if (node.cosSpread > -1) {
        const float towards = -dot(axis, w);
        const SineCosine light = lessAngle(
            lessAngle(angleOfCosine(node.bothSides ? std::fabs(towards) : towards), spread), bound);
        if (node.sharp && light.cosine < 1) return 0;
        lightCosine = larger(light.cosine, 0.0f);
    }
    const SineCosine surface = lessAngle(angleOfCosine(dot(p.shading, w)), bound);
    return node.power * lightCosine * larger(surface.cosine, 0.0f) / falloff;
}

struct ChoiceNumber {
    uint32_t value, digits;
};

inline uint32_t newDigits(ChoiceNumber& c) {
    c.digits = c.digits * 747796405u + 2891336453u;
    uint32_t x = c.digits;
    x = (x ^ x >> 16) * 0x7FEB352Du;
    x = (x ^ x >> 15) * 0x846CA68Bu;
    return x ^ x >> 16;
}

inline ChoiceNumber choiceNumber(float u, float v) {
    uint32_t a, b;
    __builtin_memcpy(&a, &u, sizeof a);
    __builtin_memcpy(&b, &v, sizeof b);
    ChoiceNumber c{0, a * 0x9E3779B1u ^ b * 0x85EBCA6Bu};
    c.value = uint32_t(int(u * 0x1p24f)) << 7 | newDigits(c) >> 25;
    return c;
}

inline float restOf(ChoiceNumber c) {
    return float(int(c.value >> 7)) * 0x1p-24f;
}

inline uint32_t valuesOfFirst(float first, float second) {
    if (!(first > 0)) return 0;
    if (!(second > 0)) return 0x80000000u;
    const float least = 0x1p31f * (smaller(first, second) / (first + second));
    const auto values = uint32_t(int(larger(least, 1.0f)));
    return first < second ? values : 0x80000000u - values;
}

inline float shareOf(uint32_t values) {
    return float(values) * 0x1p-31f;
}

inline bool choosesFirst(ChoiceNumber& c, uint32_t ofFirst) {
    const bool first = c.value < ofFirst;
    const uint32_t width = first ? ofFirst : 0x80000000u - ofFirst;
    const uint32_t offset = first ? c.value : c.value - ofFirst;
    const uint32_t digits = newDigits(c);
    const float within = float(int(digits >> 8)) * 0x1p-24f;
    const float u = smaller((float(int(offset)) + within) / float(width), 1 - kRoundoff);
    c.value = uint32_t(int(u * 0x1p24f)) << 7 | (digits & 0x7Fu);
    return first;
}

inline uint32_t pickGroup(const float light[3], ChoiceNumber& c, float& probability) {
    const uint32_t ofFirst = valuesOfFirst(light[0], light[1] + light[2]);
    const bool first = choosesFirst(c, ofFirst);
    probability = shareOf(first ? ofFirst : 0x80000000u - ofFirst);
    if (!(light[0] + light[1] + light[2] > 0)) probability = 0;
    if (first) return 0;
    const uint32_t ofSecond = valuesOfFirst(light[1], light[2]);
    const bool second = choosesFirst(c, ofSecond);
    probability *= shareOf(second ? ofSecond : 0x80000000u - ofSecond);
    return second ? 1 : 2;
}

inline uint32_t walkLightTree(const World& w, const Point& p, ChoiceNumber& c, float& probability) {
    const uint32_t* lights = w.lightsInGroup;
    const uint32_t firstLight[3] = {0, lights[0], lights[0] + lights[1]};
    probability = 1;
    uint32_t group = 0;
    while (group < 3 && lights[group] < w.lightCount)
        ++group;
    if (group == 3) { // lights of several groups
        float light[3] = {0, 0, 0};
        for (uint32_t i = 0; i < 3; ++i)
            if (lights[i] > 0)
                light[i] =
                    likelyLight(w.lightNodes[2 * firstLight[i] + 1], i, p, w.onlyNearWithoutCones);
        group = pickGroup(light, c, probability);
    }
    const LightNode* nodes = w.lightNodes + 2 * firstLight[group];
    uint32_t node = 1;
    while (node < lights[group]) {
        node *= 2;
        const float ofA = likelyLight(nodes[node], group, p, w.onlyNearWithoutCones),
                    ofB = likelyLight(nodes[node + 1], group, p, w.onlyNearWithoutCones);
        const uint32_t ofFirst = valuesOfFirst(ofA, ofB);
        const bool first = choosesFirst(c, ofFirst);
        node += first ? 0 : 1;
        const bool some = ofA > 0 || ofB > 0;
        probability *= some ? shareOf(first ? ofFirst : 0x80000000u - ofFirst) : 0.0f;
    }
    return firstLight[group] + node - lights[group];
}

inline uint32_t pickByAlias(const World& w, ChoiceNumber& c) {
    const uint64_t product = uint64_t(c.value << 1) * w.lightCount;
    const auto column = uint32_t(product >> 32);
    const AliasColumn& a = w.aliasColumns[column];
    const float within = float(int(uint32_t(product) >> 8)) * 0x1p-24f;
    const bool own = within < a.threshold;
    const float low = own ? 0.0f : a.threshold, width = own ? a.threshold : 1 - a.threshold;
    const float u = smaller(larger((within - low) / larger(width, kTiny), 0.0f), 1 - kRoundoff);
    c.value = uint32_t(int(u * 0x1p24f)) << 7 | newDigits(c) >> 25;
    return own ? column : a.alias;
}

struct PickedLight {
    const LightEntry* entry;
    float probability;
    Random2 u;
};

inline PickedLight pickLight(const World& w, const Point& p, uint32_t index, Random2 u) {
    if (w.lightChoice == gpu::LIGHT_CHOICE_ONE) return {w.lightEntries, 1, u};
    if (w.lightChoice == gpu::LIGHT_CHOICE_EACH) {
        const uint32_t sampled = w.areaLights * w.samplesPerLight;
        const uint32_t number =
            index < sampled ? index / w.samplesPerLight : w.areaLights + index - sampled;
        return {w.lightEntries + number, 1, u};
    }
    ChoiceNumber c = choiceNumber(u.x, u.y);
    float probability = 0;
    if (w.lightChoice == gpu::LIGHT_CHOICE_TREE) {
        const uint32_t number = walkLightTree(w, p, c, probability);
        return {w.lightEntries + number, probability, {restOf(c), u.y}};
    }
    const LightEntry* entry = w.lightEntries + pickByAlias(w, c);
    return {entry, entry->probability, {restOf(c), u.y}};
}

inline float lightSampleShare(const World& w, uint32_t index) {
    const bool sampledOnce =
        w.lightChoice == gpu::LIGHT_CHOICE_EACH && index >= w.areaLights * w.samplesPerLight;
    return sampledOnce ? 1.0f : 1 / float(w.samplesPerLight);
}

} // namespace
} // namespace stromboli::bench::native
