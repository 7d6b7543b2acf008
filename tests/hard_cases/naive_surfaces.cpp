#include "tests/hard_cases/naive_surfaces.hpp"

#include "scene/model/surface_lookup.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace stromboli::test::naive {
namespace {

constexpr float kPiInFloat = std::numbers::pi_v<float>;

/// 11 bits, as texture coordinates have that are stored in half precision.
float inHalf(float x) {
    return std::bit_cast<float>(std::bit_cast<uint32_t>(x) & ~0x1FFFu);
}

/// Index of the nearest texel; the remainder of a negative number is negative, and reads before the
/// picture, where everything is black.
glm::vec3 texelOf(const Scene& scene, const TextureUse& use, const glm::vec2& uv) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    const float x = inHalf(uv.x) * float(image.width), y = inHalf(uv.y) * float(image.height);
    if (!(std::abs(x) < 1e9f && std::abs(y) < 1e9f)) return glm::vec3(0); // any place at all
    const int column = int(x) % int(image.width), row = int(y) % int(image.height);
    if (column < 0 || row < 0) return glm::vec3(0);
    return glm::vec3(texelAt(image, texture.srgb, uint32_t(column), uint32_t(row)));
}

const VertexAttributes& cornerOf(const Scene& scene, const Hit& hit, size_t corner) {
    return scene
        .attributes[scene.attributeCorners[size_t(hit.triangle - scene.triangles.data())][corner]];
}

glm::vec3 directionAt(float polar, float azimuth) {
    return {-std::sin(polar) * std::sin(azimuth), std::cos(polar),
            std::sin(polar) * std::cos(azimuth)};
}

} // namespace

glm::vec3 emissionAt(const Scene& scene, const Hit& hit) {
    const TextureUse* use = textureIn(*hit.material, TextureSlot::Emission);
    if (!use || !hit.triangle) return hit.material->emission;
    return hit.material->emission * texelOf(scene, *use, cornerOf(scene, hit, 0).uv[0]);
}

glm::vec3 mappedNormal(const Scene& scene, const Hit& hit) {
    const TextureUse* use = textureIn(*hit.material, TextureSlot::Normal);
    if (!use || !hit.triangle) return hit.shading;
    const auto position = [&](int c) { return scene.positions[hit.triangle->corner[c]]; };
    const auto uv = [&](size_t c) { return cornerOf(scene, hit, c).uv[0]; };
    const glm::vec3 e1 = position(1) - position(0), e2 = position(2) - position(0);
    const glm::vec2 d1 = uv(1) - uv(0), d2 = uv(2) - uv(0);
    const float inverse = 1 / (d1.x * d2.y - d2.x * d1.y);
    glm::vec3 tangent = inverse * (d2.y * e1 - d1.y * e2);
    if (cornerOf(scene, hit, 0).tangent.w != 0)
        tangent = glm::vec3(cornerOf(scene, hit, 0).tangent);
    const glm::vec3 along = glm::normalize(tangent - glm::dot(tangent, hit.shading) * hit.shading);
    const glm::vec3 map = 2.0f * texelOf(scene, *use, {0, 0}) - 1.0f;
    return glm::normalize(map.x * along + map.y * glm::cross(hit.shading, along) +
                          map.z * hit.shading);
}

glm::vec3 skyAlong(const Environment& sky, const glm::vec3& d) {
    const float polar = std::acos(std::clamp(d.y, -1.0f, 1.0f)) / kPiInFloat;
    float azimuth = std::atan2(-d.x, d.z) / (2 * kPiInFloat);
    if (azimuth < 0) azimuth += 1;
    const uint32_t x = std::min(uint32_t(azimuth * float(sky.width)), sky.width - 1),
                   y = std::min(uint32_t(polar * float(sky.height)), sky.height - 1);
    return sky.strength * sky.radiance[size_t(y) * sky.width + x];
}

SkySample sampleSky(const Environment& sky, Random& random) {
    float sum = 0;
    for (const glm::vec3& radiance : sky.radiance)
        sum += radiance.x;
    float target = random.uniform() * sum;
    size_t i = 0;
    while (i + 1 < sky.radiance.size() && target >= sky.radiance[i].x)
        target -= sky.radiance[i++].x;
    const float x = float(i % sky.width) + random.uniform();
    const float y = float(i / sky.width) + random.uniform();
    const float density = sky.radiance[i].x / sum * float(sky.radiance.size()) / (4 * kPiInFloat);
    return {directionAt(kPiInFloat * y / float(sky.height), 2 * kPiInFloat * x / float(sky.width)),
            sky.strength * sky.radiance[i] / density};
}

glm::vec3 halfVector(const glm::vec3& n, float alpha, float u, float v) {
    const float cosine = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u));
    const float sine = std::sqrt(std::max(1 - cosine * cosine, 0.0f)), phi = 2 * kPiInFloat * v;
    const glm::vec3 other = std::abs(n.x) > 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
    const glm::vec3 x = glm::normalize(glm::cross(n, other)), y = glm::cross(n, x);
    return sine * std::cos(phi) * x + sine * std::sin(phi) * y + cosine * n;
}

float metalWeight(const glm::vec3& n, const glm::vec3& wo, const glm::vec3& wi,
                  const glm::vec3& half, float alpha) {
    const auto shadowing = [alpha](float cosine) {
        return 2 * cosine /
               (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine));
    };
    const float out = glm::dot(n, wo), in = glm::dot(n, wi);
    if (out <= 0 || in <= 0) return 0;
    return shadowing(out) * shadowing(in) * glm::dot(wo, half) /
           std::max(out * glm::dot(n, half), 1e-3f);
}

} // namespace stromboli::test::naive
