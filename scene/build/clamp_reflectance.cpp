#include "scene/build/clamp_reflectance.hpp"

#include <glm/gtc/packing.hpp>

#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace stromboli::build {
namespace {

/// A clamped copy of a picture of half floats, where anything in it exceeds the limits.
std::optional<TextureImage> clamped(const TextureImage& image, const glm::vec3& most,
                                    size_t& count) {
    std::optional<TextureImage> copy;
    for (size_t i = 0; i + 1 < image.words.size(); i += 2) {
        const glm::vec2 low = glm::unpackHalf2x16(image.words[i]);
        const glm::vec2 high = glm::unpackHalf2x16(image.words[i + 1]);
        const glm::vec3 color(low.x, low.y, high.x);
        const glm::vec3 inside = glm::clamp(color, glm::vec3(0), most);
        if (inside == color) continue;
        if (!copy) copy = image;
        copy->words[i] = glm::packHalf2x16({inside.x, inside.y});
        copy->words[i + 1] = glm::packHalf2x16({inside.z, high.y});
        ++count;
    }
    return copy;
}

} // namespace

size_t clampColors(std::vector<VertexAttributes>& attributes) {
    size_t count = 0;
    for (VertexAttributes& a : attributes) {
        const glm::vec4 before = a.color;
        for (int channel = 0; channel < 4; ++channel)
            a.color[channel] =
                a.color[channel] >= 0 ? std::min(a.color[channel], 1.0f) : 0.0f; // NaN: 0
        count += a.color != before;
    }
    return count;
}

size_t clampBaseColors(Scene& scene) {
    size_t count = 0;
    // By texture and limits: the texture that takes its place.
    std::map<std::pair<uint32_t, std::array<float, 3>>, uint32_t> made;
    for (Material& material : scene.materials) {
        const glm::vec3* factor = material.baseColor();
        if (!factor) continue;
        glm::vec3 most(1);
        for (int channel = 0; channel < 3; ++channel)
            if ((*factor)[channel] > 0) most[channel] = 1 / (*factor)[channel];
        for (TextureUse& use : material.textures) {
            if (use.slot != TextureSlot::BaseColor) continue;
            const Texture texture = scene.textures[use.texture];
            const TextureImage& image = scene.images[texture.image];
            if (image.format != TexelFormat::RgbaHalf || image.goesBeyond) continue;
            const auto [found, isNew] =
                made.try_emplace({use.texture, {most.x, most.y, most.z}}, use.texture);
            if (isNew)
                if (auto copy = clamped(image, most, count)) {
                    found->second = uint32_t(scene.textures.size());
                    scene.textures.push_back(texture);
                    scene.textures.back().image = uint32_t(scene.images.size());
                    scene.images.push_back(std::move(*copy));
                }
            use.texture = found->second;
        }
    }
    return count;
}

} // namespace stromboli::build
