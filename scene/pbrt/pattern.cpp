#include "scene/pbrt/pattern.hpp"

#include "scene/build/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace stromboli::pbrt {
namespace {

constexpr uint32_t kMostTexels = 2048; ///< of a side of pictures that are made
constexpr uint32_t kLeastTexels = 512; ///< of those that are made of others in other places

/// The permutation of Perlin's paper.
constexpr std::array<uint8_t, 256> kPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103,
    30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,
    197, 62,  94,  252, 219, 203, 117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174,
    20,  125, 136, 171, 168, 68,  175, 74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231,
    83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143,
    54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169, 200, 196,
    135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250, 124,
    123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,
    182, 189, 28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101,
    155, 167, 43,  172, 9,   129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185,
    112, 104, 218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,
    51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157, 184, 84,  204, 176,
    115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114, 67,  29,  24,  72,  243,
    141, 128, 195, 78,  66,  215, 61,  156, 180};

double gradient(int x, int y, int z, const glm::dvec3& d) {
    const auto at = [](int i) { return int(kPermutation[size_t(i & 255)]); };
    const int h = at(at(at(x) + y) + z) & 15;
    // pbrt's choice of axes, by which its dots lie where they do.
    const bool isLast = h == 12 || h == 13;
    const double u = h < 8 || isLast ? d.x : d.y, v = h < 4 || isLast ? d.y : d.z;
    return ((h & 1) != 0 ? -u : u) + ((h & 2) != 0 ? -v : v);
}

/// The pattern by the surface's own coordinates.
glm::dvec3 atUv(const Pattern& pattern, const glm::dvec2& uv) {
    return pattern.valueAt(pattern.mapping.scale * uv + pattern.mapping.offset);
}

/// So many units of the surface's coordinates, after which all parts begin again, or 1.
glm::dvec2 commonPeriod(std::span<const Pattern> parts) {
    constexpr int kMost = 4;
    glm::dvec2 period(1);
    for (const int axis : {0, 1})
        for (int units = kMost; units > 0; --units) {
            const auto beginsAgain = [&](const Pattern& part) {
                const double times = units * part.mapping.scale[axis] / part.period[axis];
                return part.isConstant || std::abs(times - std::round(times)) < 1e-6;
            };
            if (std::ranges::all_of(parts, beginsAgain)) period[axis] = units;
        }
    return period;
}

} // namespace

glm::dvec2 Mapping::at(const glm::dvec3& world) const {
    const glm::dvec3 place(textureFromWorld * glm::dvec4(world, 1));
    if (kind == Kind::Planar)
        return offset + glm::dvec2(glm::dot(place, sAxis), glm::dot(place, tAxis));
    const glm::dvec3 p = build::unit(place).value_or(glm::dvec3(0));
    const double phi = std::atan2(p.y, p.x);
    if (kind == Kind::Cylindrical)
        return {(std::numbers::pi + phi) / (2 * std::numbers::pi), isOfUnitSphere ? p.z : place.z};
    return {std::acos(std::clamp(p.z, -1.0, 1.0)) / std::numbers::pi,
            (phi < 0 ? phi + 2 * std::numbers::pi : phi) / (2 * std::numbers::pi)};
}

Pattern Pattern::constant(const glm::dvec3& color) {
    Pattern pattern;
    pattern.color = color;
    return pattern;
}

glm::dvec3 Pattern::mean() const {
    if (isConstant) return color;
    const uint32_t columns = std::clamp(texels.x, 1u, 256u), rows = std::clamp(texels.y, 1u, 256u);
    glm::dvec3 sum(0.0);
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column)
            sum += at(period * glm::dvec2((column + 0.5) / columns, (row + 0.5) / rows));
    return sum / (double(columns) * rows);
}

bool combine(const Pattern& a, const Pattern& b, const Pattern& c, const Combine& how,
             Pattern& result) {
    result = Pattern();
    const std::array<const Pattern*, 3> all = {&a, &b, &c};
    std::array<Pattern, 3> parts;
    const Pattern* first = nullptr;
    bool isWhole = true, areAlike = true;
    for (size_t i = 0; i < all.size(); ++i) {
        parts[i] = *all[i];
        if (all[i]->isConstant) continue;
        if (!first) first = all[i];
        if (first->mapping.kind != all[i]->mapping.kind) {
            parts[i] = Pattern::constant(all[i]->mean());
            isWhole = false;
        } else {
            areAlike = areAlike && first->mapping == all[i]->mapping;
        }
    }
    if (!first) {
        result.color = how(a.color, b.color, c.color);
        return isWhole;
    }
    result.isConstant = false;
    result.isNearest = true;
    const bool isByUv = !areAlike && first->mapping.kind == Mapping::Kind::Uv;
    // Places between texels of one are no such places of another.
    if (isByUv) {
        result.period = commonPeriod(parts);
        result.texels = glm::uvec2(kLeastTexels);
    }
    if (!isByUv) result.mapping = first->mapping;
    for (const Pattern& part : parts) {
        if (part.isConstant) continue;
        result.isNearest = result.isNearest && part.isNearest;
        if (part.wrap != Wrap::Repeat) result.wrap = part.wrap;
        if (isByUv) {
            const glm::dvec2 needed = glm::dvec2(part.texels) * result.period *
                                      glm::abs(part.mapping.scale) / part.period;
            result.texels =
                glm::max(result.texels, glm::uvec2(glm::clamp(needed, 1.0, double(kMostTexels))));
        } else {
            result.period = glm::max(result.period, part.period);
        }
    }
    if (!isByUv)
        for (const Pattern& part : parts)
            if (!part.isConstant)
                result.texels = glm::max(
                    result.texels,
                    glm::uvec2(glm::clamp(glm::dvec2(part.texels) * result.period / part.period,
                                          1.0, double(kMostTexels))));
    // What is alike within a texel of one is not so within those of others.
    const bool hasOneSize = std::ranges::all_of(parts, [&](const Pattern& part) {
        return part.isConstant || part.texels == result.texels;
    });
    result.isNearest = result.isNearest && hasOneSize;
    result.at = [parts, how, isByUv](const glm::dvec2& st) {
        const auto at = [&](const Pattern& part) {
            return isByUv ? atUv(part, st) : part.valueAt(st);
        };
        return how(at(parts[0]), at(parts[1]), at(parts[2]));
    };
    return isWhole;
}

double noise(const glm::dvec3& p) {
    const glm::dvec3 below = glm::floor(p), d = p - below;
    const glm::ivec3 cell(below - 256.0 * glm::floor(below / 256.0));
    const glm::dvec3 w = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
    double corners[8];
    for (int i = 0; i < 8; ++i) {
        const int x = i & 1, y = i >> 1 & 1, z = i >> 2;
        corners[i] = gradient(cell.x + x, cell.y + y, cell.z + z, d - glm::dvec3(x, y, z));
    }
    for (int i = 0; i < 4; ++i)
        corners[i] = std::lerp(corners[2 * i], corners[2 * i + 1], w.x);
    for (int i = 0; i < 2; ++i)
        corners[i] = std::lerp(corners[2 * i], corners[2 * i + 1], w.y);
    return std::lerp(corners[0], corners[1], w.z);
}

} // namespace stromboli::pbrt
