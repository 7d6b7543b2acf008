#pragma once

#include "scene/build/mesh.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/ply/body.hpp"
#include "scene/ply/load_ply.hpp"

#include <optional>

namespace stromboli::ply {

/// What the vertices of a file have, one of each for every vertex.
struct Vertices {
    std::vector<glm::dvec3> positions;
    std::vector<glm::dvec3> normals;          ///< empty: the file states none
    std::vector<VertexAttributes> attributes; ///< empty: neither colours nor texture coordinates
    bool hasColors = false, hasUv = false;
    bool hasAlpha = false; ///< some vertices are not opaque
};

/// Which number of the attribute of that name (PlyAttribute) it is: 0, 1 or 2, red, green and blue
/// of colours.
std::optional<int> channelOfAttribute(const Property& property, const std::string& name);
/// The number that stands for 1 in a colour of this type. Whole numbers are sRGB, floats linear.
double fullScale(ScalarType type);

/// Reads all vertices, which `body` is at the beginning of. Throws SceneError if they have no x, y
/// and z. Those that are not finite are kept: many files have vertices that no face uses.
/// colors: the name of the attribute that their colours are; stated: what else is known of them.
Vertices readVertices(const Element& element, Body& body, build::SceneBuilder& builder,
                      const std::string& colors, const PlyAttribute& stated);

} // namespace stromboli::ply
