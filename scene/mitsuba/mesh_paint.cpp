#include "scene/mitsuba/mesh_paint.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

/// The triangles of a mesh in rows, as near to a square as may be.
struct Grid {
    uint32_t columns, rows;

    explicit Grid(const build::Mesh& mesh) {
        const size_t triangles = std::max<size_t>(mesh.parts.front().size(), 1);
        columns = uint32_t(std::ceil(std::sqrt(double(triangles))));
        rows = uint32_t((triangles + columns - 1) / columns);
    }
};

glm::dvec3 colorOf(const build::Mesh& mesh, const build::Corner& corner) {
    if (corner.attributes == kNoAttributes) return glm::dvec3(1);
    return glm::dvec3(glm::vec3(mesh.attributes[corner.attributes].color));
}

} // namespace

TextureImage paintOfCorners(const build::Mesh& mesh, const Paint& paint) {
    const Grid grid(mesh);
    const build::MeshPart& triangles = mesh.parts.front();
    TextureImage image{
        "mesh attribute", 2 * grid.columns, 2 * grid.rows, TexelFormat::RgbaHalf, {}};
    image.goesBeyond = true;
    image.words.reserve(8 * size_t(grid.columns) * grid.rows);
    for (uint32_t row = 0; row < image.height; ++row)
        for (uint32_t column = 0; column < grid.columns; ++column) {
            std::array<glm::dvec3, 3> at{};
            const size_t triangle = size_t(row / 2) * grid.columns + column;
            if (triangle < triangles.size())
                for (size_t k = 0; k < 3; ++k) {
                    at[k] = colorOf(mesh, triangles[triangle][k]);
                    if (paint.isFraction) at[k] = glm::clamp(at[k], 0.0, 1.0);
                }
            const bool isUpper = row % 2 == 0;
            build::appendTexel(image.words, isUpper ? at[0] : at[2], paint.layout);
            build::appendTexel(image.words, isUpper ? at[1] : at[1] + at[2] - at[0], paint.layout);
        }
    return image;
}

void spreadCorners(build::Mesh& mesh) {
    const Grid grid(mesh);
    std::vector<VertexAttributes> attributes;
    attributes.reserve(3 * mesh.parts.front().size());
    size_t triangle = 0;
    for (build::MeshTriangle& corners : mesh.parts.front()) {
        const glm::dvec2 block(double(triangle % grid.columns), double(triangle / grid.columns));
        for (size_t k = 0; k < 3; ++k) {
            VertexAttributes a;
            if (corners[k].attributes != kNoAttributes) a = mesh.attributes[corners[k].attributes];
            const glm::dvec2 texel(k == 1 ? 1.5 : 0.5, k == 2 ? 1.5 : 0.5);
            a.uv[1] = (2.0 * block + texel) / glm::dvec2(2 * grid.columns, 2 * grid.rows);
            corners[k].attributes = uint32_t(attributes.size());
            attributes.push_back(a);
        }
        ++triangle;
    }
    mesh.attributes = std::move(attributes);
}

} // namespace stromboli::mitsuba
