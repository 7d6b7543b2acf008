#include "scene/model/mean_emission.hpp"

#include "host/core/color.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli {
namespace {

/// Points along an edge of the grid on a triangle: 36 points in all.
constexpr int kGrid = 8;

/// Which blocks of one axis a range of texture coordinates touches: [first, last], to be taken
/// modulo the number of blocks. All of them where the range is not known or as wide as the picture.
struct BlockRange {
    int64_t first, last;
};

BlockRange blocksWithin(double least, double most, Wrap wrap, uint32_t texels, uint32_t block,
                        uint32_t blocks) {
    const BlockRange all{0, int64_t(blocks) - 1};
    if (!(std::abs(least) < 0x1p24 && std::abs(most) < 0x1p24)) return all;
    const double turn = std::floor(least);
    // Within one copy of the picture: what it shows beyond, and what mirrored copies show, is found
    // among all of it.
    if (wrap != Wrap::Clamp && (most - turn > 1 || (wrap == Wrap::Mirror && turn != 0))) return all;
    if (wrap == Wrap::Repeat) least -= turn, most -= turn;
    // A filter reaches half a texel beyond; with a whole one, rounding has no effect.
    const double n = texels, first = least * n - 1, last = most * n + 1;
    if (wrap == Wrap::Repeat && (first < 0 || last >= n)) return all;
    const auto index = [&](double x) {
        return int64_t(std::clamp(std::floor(x), 0.0, n - 1)) / int64_t(block);
    };
    return {index(first), index(last)};
}

} // namespace

MeanEmission::MeanEmission(const Scene& scene) : scene_(scene) {
    for (const Material& m : scene.materials) {
        if (!m.emits()) continue;
        for (const TextureUse& use : m.textures)
            if (use.slot == TextureSlot::Emission && !blocks_.contains(use.texture))
                blocks_[use.texture] = blocksOf(scene.textures[use.texture]);
    }
}

MeanEmission::Blocks MeanEmission::blocksOf(const Texture& texture) const {
    const TextureImage& image = scene_.images[texture.image];
    Blocks b;
    b.columns = (image.width + kBlock - 1) / kBlock;
    b.rows = (image.height + kBlock - 1) / kBlock;
    b.largest.assign(size_t(b.columns) * b.rows, glm::vec3(0));
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            glm::vec3& largest = b.largest[size_t(y / kBlock) * b.columns + x / kBlock];
            largest = glm::max(largest, glm::vec3(texelAt(image, texture.srgb, x, y)));
        }
    return b;
}

glm::dvec3 MeanEmission::largestOn(uint32_t triangle, const TextureUse& use) const {
    glm::dvec2 least(INFINITY), most(-INFINITY);
    constexpr std::array<glm::dvec2, 3> kCorners = {glm::dvec2(0, 0), {1, 0}, {0, 1}};
    for (const glm::dvec2& corner : kCorners) {
        const PointAttributes at = attributesAt(scene_, triangle, corner.x, corner.y);
        const glm::dvec3 uv1(at.uv[use.uvSet], 1.0);
        const glm::dvec2 uv(glm::dot(glm::dvec3(use.uRow), uv1),
                            glm::dot(glm::dvec3(use.vRow), uv1));
        // What is not a number is no bound: it makes the range one that is not known.
        for (int axis = 0; axis < 2; ++axis) {
            const double u = std::isfinite(uv[axis]) ? uv[axis] : 0x1p30;
            least[axis] = std::min(least[axis], u), most[axis] = std::max(most[axis], u);
        }
    }
    const Texture& texture = scene_.textures[use.texture];
    const TextureImage& image = scene_.images[texture.image];
    const Blocks& blocks = blocks_.at(use.texture);
    const BlockRange columns =
        blocksWithin(least.x, most.x, texture.wrapU, image.width, kBlock, blocks.columns);
    const BlockRange rows =
        blocksWithin(least.y, most.y, texture.wrapV, image.height, kBlock, blocks.rows);
    glm::vec3 largest(0);
    for (int64_t y = rows.first; y <= rows.last; ++y)
        for (int64_t x = columns.first; x <= columns.last; ++x)
            largest = glm::max(largest, blocks.largest[size_t(y) * blocks.columns + size_t(x)]);
    return glm::dvec3(largest);
}

glm::dvec3 MeanEmission::ofTriangle(uint32_t triangle) const {
    const Material& m = scene_.materials[scene_.triangles[triangle].material];
    if (!textureIn(m, TextureSlot::Emission) && m.alphaMode == AlphaMode::Opaque) return m.emission;
    glm::dvec3 largest(m.emission);
    for (const TextureUse& use : m.textures)
        if (use.slot == TextureSlot::Emission) largest *= largestOn(triangle, use);
    glm::dvec3 sum(0.0);
    int points = 0;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; i + j < kGrid; ++j, ++points) {
            // Centres of the triangles of the grid that are not upside down.
            const double b1 = (i + 1.0 / 3) / kGrid, b2 = (j + 1.0 / 3) / kGrid;
            const PointAttributes at = attributesAt(scene_, triangle, b1, b2);
            sum += emissionAt(scene_, m, at) * opacityAt(scene_, m, at);
        }
    // One more point, as bright as any may be, stands for all that the grid has missed (Laplace's
    // rule of succession).
    return (sum + largest) / double(points + 1);
}

glm::dvec3 MeanEmission::ofSphere(uint32_t sphere) const {
    const Material& m = scene_.materials[scene_.spheres[sphere].material];
    return emissionAt(scene_, m, {}) * opacityAt(scene_, m, {});
}

double MeanEmission::powerOfTriangle(uint32_t index) const {
    const Triangle& t = scene_.triangles[index];
    const glm::dvec3 a = scene_.positions[t.corner[0]], b = scene_.positions[t.corner[1]],
                     c = scene_.positions[t.corner[2]];
    const double area = 0.5 * glm::length(glm::cross(b - a, c - a));
    return luminance(ofTriangle(index)) * area *
           (scene_.materials[t.material].emitsBothSides ? 2 : 1);
}

} // namespace stromboli
