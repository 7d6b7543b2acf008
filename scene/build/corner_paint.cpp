#include "scene/build/corner_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::build {
namespace {

/// The triangles of a part in rows, as near to a square as may be.
struct Grid {
    uint32_t columns, rows;

    explicit Grid(const MeshPart& part) {
        const size_t triangles = std::max<size_t>(part.size(), 1);
        columns = uint32_t(std::ceil(std::sqrt(double(triangles))));
        rows = uint32_t((triangles + columns - 1) / columns);
    }
};

glm::dvec3 colorOf(const std::vector<VertexAttributes>& attributes, const Corner& corner) {
    if (corner.attributes == kNoAttributes) return glm::dvec3(1);
    return glm::dvec3(glm::vec3(attributes[corner.attributes].color));
}

} // namespace

TextureImage paintOfCorners(const std::vector<VertexAttributes>& attributes, const MeshPart& part,
                            Layout layout, bool isFraction) {
    const Grid grid(part);
    TextureImage image{
        "colours of corners", 2 * grid.columns, 2 * grid.rows, TexelFormat::RgbaHalf, {}};
    image.goesBeyond = true;
    image.words.reserve(8 * size_t(grid.columns) * grid.rows);
    for (uint32_t row = 0; row < image.height; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column) {
            std::array<glm::dvec3, 3> at{};
            const size_t triangle = size_t(row / 2) * grid.columns + column;
            if (triangle < part.size())
                for (size_t k = 0; k < 3; ++k) {
                    at[k] = colorOf(attributes, part[triangle][k]);
                    if (isFraction) at[k] = glm::clamp(at[k], 0.0, 1.0);
                }
            const bool isUpper = row % 2 == 0;
            appendTexel(image.words, isUpper ? at[0] : at[2], layout);
            appendTexel(image.words, isUpper ? at[1] : at[1] + at[2] - at[0], layout);
        }
    return image;
}

std::vector<VertexAttributes> spreadCorners(const std::vector<VertexAttributes>& from,
                                            MeshPart& part, uint32_t uvSet, size_t first) {
    const Grid grid(part);
    std::vector<VertexAttributes> attributes;
    attributes.reserve(3 * part.size());
    size_t triangle = 0;
    for (MeshTriangle& corners : part) {
        const glm::dvec2 block(double(triangle % grid.columns), double(triangle / grid.columns));
        for (size_t k = 0; k < 3; ++k) {
            VertexAttributes a;
            if (corners[k].attributes != kNoAttributes) a = from[corners[k].attributes];
            const glm::dvec2 texel(k == 1 ? 1.5 : 0.5, k == 2 ? 1.5 : 0.5);
            a.uv[uvSet] = (2.0 * block + texel) / glm::dvec2(2 * grid.columns, 2 * grid.rows);
            corners[k].attributes = uint32_t(first + attributes.size());
            attributes.push_back(a);
        }
        ++triangle;
    }
    return attributes;
}

} // namespace stromboli::build
