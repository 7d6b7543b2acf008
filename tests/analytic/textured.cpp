#include "tests/analytic/textured.hpp"

#include <glm/gtc/packing.hpp>

namespace stromboli::test {

uint32_t TextureMaker::bytes(uint32_t width, uint32_t height,
                             const std::vector<glm::vec4>& texels) {
    TextureImage image;
    image.width = width, image.height = height;
    for (const glm::vec4& t : texels)
        image.words.push_back(glm::packUnorm4x8(t));
    scene_.images.push_back(image);
    return uint32_t(scene_.images.size() - 1);
}

uint32_t TextureMaker::halves(uint32_t width, uint32_t height,
                              const std::vector<glm::vec4>& texels) {
    TextureImage image;
    image.width = width, image.height = height;
    image.format = TexelFormat::RgbaHalf;
    for (const glm::vec4& t : texels) {
        image.words.push_back(glm::packHalf2x16({t.x, t.y}));
        image.words.push_back(glm::packHalf2x16({t.z, t.w}));
    }
    scene_.images.push_back(image);
    return uint32_t(scene_.images.size() - 1);
}

uint32_t TextureMaker::texture(const Texture& texture) {
    scene_.textures.push_back(texture);
    return uint32_t(scene_.textures.size() - 1);
}

void TextureMaker::attributes(
    size_t triangles, const std::function<VertexAttributes(const glm::vec3& position)>& at) {
    constexpr std::array<uint32_t, 3> none = {kNoAttributes, kNoAttributes, kNoAttributes};
    scene_.attributeCorners.resize(scene_.triangles.size(), none);
    for (size_t i = scene_.triangles.size() - triangles; i < scene_.triangles.size(); ++i)
        for (uint32_t c = 0; c < 3; ++c) {
            scene_.attributeCorners[i][c] = uint32_t(scene_.attributes.size());
            scene_.attributes.push_back(at(scene_.positions[scene_.triangles[i].corner[c]]));
        }
}

void addTexturedSquare(SceneMaker& maker, uint32_t material, float scale, const glm::vec3& offset) {
    maker.quad(offset, {1, 0, 0}, {0, 1, 0}, material);
    TextureMaker(maker.scene).attributes(2, [&](const glm::vec3& p) {
        VertexAttributes a;
        a.uv[0] = scale * glm::vec2(p.x - offset.x, 1 - (p.y - offset.y));
        return a;
    });
}

} // namespace stromboli::test
