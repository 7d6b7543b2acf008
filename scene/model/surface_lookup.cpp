#include "scene/model/surface_lookup.hpp"

#include "scene/model/srgb.hpp"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli {
namespace {

/// Where a coordinate lies between the edges of a picture of n texels, in texels.
double inTexels(double u, Wrap wrap, uint32_t n) {
    if (wrap == Wrap::Clamp) return u > 0 ? std::min(u, 1.0) * n : 0;
    if (!(std::abs(u) < 0x1p24)) u = 0;
    if (wrap == Wrap::Repeat) return (u - std::floor(u)) * n;
    const double part = std::abs(std::remainder(u, 2.0)); // [0, 1]: distance to the next even
    return part * n;
}

bool isMirroredAt(double u, Wrap wrap) {
    return wrap == Wrap::Mirror && std::abs(u) < 0x1p24 && std::remainder(u, 2.0) < 0;
}

uint32_t texelIndex(int64_t i, Wrap wrap, uint32_t n) {
    if (wrap == Wrap::Repeat) return uint32_t((i + n) % n);
    return uint32_t(std::clamp<int64_t>(i, 0, int64_t(n) - 1)); // mirrored, the edge meets itself
}

/// Numbers of bytes. What a picture emits in all is summed over millions of texels, and a power for
/// each of their channels took most of the time.
struct BytesDecoded {
    std::array<double, 256> fraction, light;
    BytesDecoded() {
        for (size_t byte = 0; byte < 256; ++byte) {
            fraction[byte] = double(byte) / 255;
            light[byte] = srgbToLinear(fraction[byte]);
        }
    }
};

} // namespace

glm::dvec4 texelAt(const TextureImage& image, bool srgb, uint32_t x, uint32_t y) {
    const size_t index = size_t(y) * image.width + x;
    if (image.format == TexelFormat::RgbaHalf) {
        const glm::vec2 first = glm::unpackHalf2x16(image.words[2 * index]),
                        second = glm::unpackHalf2x16(image.words[2 * index + 1]);
        return {first.x, first.y, second.x, second.y};
    }
    static const BytesDecoded decoded;
    const std::array<double, 256>& color = srgb ? decoded.light : decoded.fraction;
    const uint32_t word = image.words[index];
    return {color[word & 0xFF], color[word >> 8 & 0xFF], color[word >> 16 & 0xFF],
            decoded.fraction[word >> 24]};
}

PointAttributes attributesAt(const Scene& scene, uint32_t triangle, double b1, double b2) {
    PointAttributes at;
    if (scene.attributeCorners.empty()) return at;
    const auto& corners = scene.attributeCorners[triangle];
    if (corners[0] == kNoAttributes) return at;
    const VertexAttributes &a0 = scene.attributes[corners[0]], &a1 = scene.attributes[corners[1]],
                           &a2 = scene.attributes[corners[2]];
    // By differences: what is the same at all corners is exactly that everywhere, which a mask
    // whose opacity is its cutoff depends on.
    const auto mixed = [&](auto x0, auto x1, auto x2) {
        return x0 + b1 * (x1 - x0) + b2 * (x2 - x0);
    };
    for (int set = 0; set < 2; ++set)
        at.uv[set] = mixed(glm::dvec2(a0.uv[set]), glm::dvec2(a1.uv[set]), glm::dvec2(a2.uv[set]));
    at.color = mixed(glm::dvec4(a0.color), glm::dvec4(a1.color), glm::dvec4(a2.color));
    return at;
}

const TextureUse* textureIn(const Material& material, TextureSlot slot) {
    for (const TextureUse& use : material.textures)
        if (use.slot == slot) return &use;
    return nullptr;
}

glm::dvec4 lookUp(const Scene& scene, const TextureUse& use, const PointAttributes& at) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    const glm::dvec3 uv1(at.uv[use.uvSet], 1.0);
    const double x = inTexels(glm::dot(glm::dvec3(use.uRow), uv1), texture.wrapU, image.width);
    const double y = inTexels(glm::dot(glm::dvec3(use.vRow), uv1), texture.wrapV, image.height);
    if (texture.nearest)
        return texelAt(image, texture.srgb, std::min(uint32_t(x), image.width - 1),
                       std::min(uint32_t(y), image.height - 1));
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double fx = x - 0.5 - left, fy = y - 0.5 - top;
    glm::dvec4 sum(0.0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const double weight = (i ? fx : 1 - fx) * (j ? fy : 1 - fy);
            sum += weight * texelAt(image, texture.srgb,
                                    texelIndex(int64_t(left) + i, texture.wrapU, image.width),
                                    texelIndex(int64_t(top) + j, texture.wrapV, image.height));
        }
    return sum;
}

glm::dvec2 slopeOf(const Scene& scene, const TextureUse& use, const PointAttributes& at) {
    const Texture& texture = scene.textures[use.texture];
    if (texture.nearest) return glm::dvec2(0.0);
    const TextureImage& image = scene.images[texture.image];
    const glm::dvec3 uv1(at.uv[use.uvSet], 1.0), uRow(use.uRow), vRow(use.vRow);
    const double u = glm::dot(uRow, uv1), v = glm::dot(vRow, uv1);
    const double x = inTexels(u, texture.wrapU, image.width) - 0.5;
    const double y = inTexels(v, texture.wrapV, image.height) - 0.5;
    const auto left = int64_t(std::floor(x)), top = int64_t(std::floor(y));
    const auto red = [&](int64_t i, int64_t j) {
        return texelAt(image, texture.srgb, texelIndex(left + i, texture.wrapU, image.width),
                       texelIndex(top + j, texture.wrapV, image.height))
            .x;
    };
    const double fx = x - double(left), fy = y - double(top);
    double alongX = (1 - fy) * (red(1, 0) - red(0, 0)) + fy * (red(1, 1) - red(0, 1));
    double alongY = (1 - fx) * (red(0, 1) - red(0, 0)) + fx * (red(1, 1) - red(1, 0));
    // Where a picture is mirrored, it is read backwards.
    if (isMirroredAt(u, texture.wrapU)) alongX = -alongX;
    if (isMirroredAt(v, texture.wrapV)) alongY = -alongY;
    return alongX * image.width * glm::dvec2(uRow) + alongY * image.height * glm::dvec2(vRow);
}

double opacityAt(const Scene& scene, const Material& material, const PointAttributes& at) {
    if (material.alphaMode == AlphaMode::Opaque) return 1;
    double opacity = double(material.opacity) * at.color.a;
    if (const TextureUse* use = textureIn(material, TextureSlot::BaseColor))
        opacity *= lookUp(scene, *use, at).a;
    if (const TextureUse* use = textureIn(material, TextureSlot::Opacity)) {
        const double texel = lookUp(scene, *use, at).r;
        opacity *= use->scale < 0 ? 1 - texel : texel;
    }
    if (material.alphaMode == AlphaMode::Mask) return opacity >= material.alphaCutoff ? 1 : 0;
    return std::clamp(opacity, 0.0, 1.0);
}

double otherShareAt(const Scene& scene, const Material& material, const PointAttributes& at) {
    if (material.other == kNoMaterial) return 0;
    double share = material.otherShare;
    if (const TextureUse* use = textureIn(material, TextureSlot::BlendShare))
        share *= lookUp(scene, *use, at).r;
    return std::min(share, 1.0);
}

glm::dvec3 emissionAt(const Scene& scene, const Material& material, const PointAttributes& at) {
    glm::dvec3 emission = material.emission;
    for (const TextureUse& use : material.textures)
        if (use.slot == TextureSlot::Emission) emission *= glm::dvec3(lookUp(scene, use, at));
    return emission;
}

uint32_t uvSetOfTangents(const Material& material) {
    for (const TextureSlot slot :
         {TextureSlot::Normal, TextureSlot::ClearcoatNormal, TextureSlot::Anisotropy})
        if (const TextureUse* use = textureIn(material, slot)) return use->uvSet;
    return 0;
}

glm::vec4 tangentAtCorner(const Scene& scene, uint32_t triangle, uint32_t corner, uint32_t uvSet) {
    if (scene.attributeCorners.empty()) return glm::vec4(0);
    const auto& corners = scene.attributeCorners[triangle];
    if (corners[0] == kNoAttributes) return glm::vec4(0);
    const auto attributes = [&](uint32_t c) { return scene.attributes[corners[c]]; };
    if (attributes(corner).tangent.w != 0) return attributes(corner).tangent;
    const Triangle& t = scene.triangles[triangle];
    const auto position = [&](uint32_t c) { return glm::dvec3(scene.positions[t.corner[c]]); };
    const auto uv = [&](uint32_t c) { return glm::dvec2(attributes(c).uv[uvSet]); };
    const glm::dvec3 e1 = position(1) - position(0), e2 = position(2) - position(0);
    const glm::dvec2 d1 = uv(1) - uv(0), d2 = uv(2) - uv(0);
    const double determinant = d1.x * d2.y - d2.x * d1.y;
    const glm::dvec3 alongU = (determinant < 0 ? -1.0 : 1.0) * (d2.y * e1 - d1.y * e2);
    const double length = glm::length(alongU);
    // Written so that NaN is no tangent either.
    if (!(std::abs(determinant) > 0 && length > 0 && std::isfinite(length))) return glm::vec4(0);
    // Where texture coordinates are not mirrored, normal x tangent points against v.
    return glm::vec4(glm::vec3(alongU / length), determinant < 0 ? 1.0f : -1.0f);
}

} // namespace stromboli
