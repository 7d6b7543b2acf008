#pragma once

#include "tests/scene/gltf/gltf_text.hpp"
#include "tests/scene/images/encoders.hpp"

namespace stromboli::test {

// Files of one material.

/// A triangle of a material, with textures 0 (a picture of 2 x 1 texels) and 1 (16 bits).
inline GltfText withMaterial(const std::string& material) {
    GltfText g;
    const size_t uv0 = g.addAccessor<float>({0, 1, 1, 1, 0, 0}, "VEC2");
    const size_t uv3 = g.addAccessor<float>({5, 6, 5, 5, 6, 6}, "VEC2");
    g.addTriangle(R"(, "material": 0)",
                  fmt::format(R"(, "TEXCOORD_0": {}, "TEXCOORD_3": {})", uv0, uv3));
    const size_t view = g.addView(png8(2, 1, 3, {1, 2, 3, 4, 5, 6}));
    g.addTo("images", fmt::format(R"("bufferView": {}, "mimeType": "image/png")", view));
    g.addTo("images", fmt::format(R"("uri": "data:image/png;base64,{}")",
                                  toBase64(png16(1, 1, 3, {0, 32768, 65535}))));
    g.addTo("samplers", R"("wrapS": 33071, "wrapT": 33648, "magFilter": 9728)");
    g.addTo("textures", R"("source": 0, "sampler": 0)");
    g.addTo("textures", R"("source": 1)");
    g.addTo("materials", material);
    return g;
}

inline Scene sceneOf(const std::string& material) {
    return load(withMaterial(material));
}

inline Material materialOf(const std::string& material) {
    const Scene scene = sceneOf(material);
    return scene.materials.at(scene.triangles.at(0).material);
}

inline const TextureUse* useOf(const Material& material, TextureSlot slot) {
    for (const TextureUse& use : material.textures)
        if (use.slot == slot) return &use;
    return nullptr;
}

inline std::string extension(const std::string& name, const std::string& members) {
    return fmt::format(R"("extensions": {{"{}": {{{}}}}})", name, members);
}

} // namespace stromboli::test
