#include "host/bench/texture_means.hpp"

#include "scene/model/surface_lookup.hpp"

namespace stromboli::bench {
namespace {

glm::dvec4 meanOf(const Scene& scene, const TextureUse& use) {
    const Texture& texture = scene.textures[use.texture];
    const TextureImage& image = scene.images[texture.image];
    glm::dvec4 sum(0);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            sum += texelAt(image, texture.srgb, x, y);
    return sum / double(uint64_t(image.width) * image.height);
}

void multiplyByMean(const Scene& scene, const TextureUse& use, Material& m) {
    if (use.slot == TextureSlot::BaseColor) {
        const glm::vec3 mean(meanOf(scene, use));
        m.albedo *= mean;
        m.principled.baseColor *= mean;
    }
    if (use.slot == TextureSlot::MetallicRoughness) {
        const glm::vec4 mean(meanOf(scene, use));
        m.principled.roughness *= mean.g;
        m.principled.metallic *= mean.b;
    }
}

bool opacityHasTexture(const Material& m) {
    return m.alphaMode != AlphaMode::Opaque &&
           (textureIn(m, TextureSlot::BaseColor) || textureIn(m, TextureSlot::Opacity));
}

/// Over texture coordinates from 0 to 1, as a render looks textures up: a mask's edge runs between
/// texels.
float meanOpacity(const Scene& scene, const Material& m) {
    constexpr uint32_t kPlaces = 256; // a side
    double sum = 0;
    for (uint32_t y = 0; y < kPlaces; ++y)
        for (uint32_t x = 0; x < kPlaces; ++x) {
            const glm::dvec2 uv((x + 0.5) / kPlaces, (y + 0.5) / kPlaces);
            sum += opacityAt(scene, m, {.uv = {uv, uv}});
        }
    return float(sum / (kPlaces * kPlaces));
}

} // namespace

Scene withMeans(Scene scene) {
    for (Material& m : scene.materials) {
        if (opacityHasTexture(m)) {
            m.opacity = meanOpacity(scene, m);
            m.alphaMode = AlphaMode::Blend;
        }
        for (const TextureUse& use : m.textures)
            multiplyByMean(scene, use, m);
        m.textures.clear();
    }
    return scene;
}

} // namespace stromboli::bench
