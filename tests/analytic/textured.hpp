#pragma once

#include "scene/generate/scene_maker.hpp"

#include <functional>

namespace stromboli::test {

using namespace scenes;

/// Adds textures and attributes of corners to a scene made in code.
class TextureMaker {
  public:
    explicit TextureMaker(Scene& scene) : scene_(scene) {}

    /// Texels from the top, row after row; each a fraction that is stored in 8 bits.
    uint32_t bytes(uint32_t width, uint32_t height, const std::vector<glm::vec4>& texels);
    /// A picture in half floats.
    uint32_t halves(uint32_t width, uint32_t height, const std::vector<glm::vec4>& texels);
    uint32_t texture(const Texture& texture);
    /// A bilinear, linear texture that repeats.
    uint32_t texture(uint32_t image) { return texture(Texture{.image = image}); }
    /// One colour everywhere.
    uint32_t constant(const glm::vec4& color) { return texture(halves(1, 1, {color})); }

    /// Gives the corners of the last `triangles` triangles attributes by where they are.
    void attributes(size_t triangles,
                    const std::function<VertexAttributes(const glm::vec3& position)>& at);

  private:
    Scene& scene_;
};

/// A unit square from the origin in the plane z = 0, normal +z, with texture coordinates from (0,
/// 0) at its upper left corner (0, 1, 0), u to the right and v downwards, times `scale`.
void addTexturedSquare(SceneMaker& maker, uint32_t material, float scale = 1,
                       const glm::vec3& offset = glm::vec3(0));

} // namespace stromboli::test
