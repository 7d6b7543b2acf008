#pragma once

#include "scene/model/scene.hpp"

namespace stromboli {

// What textures and the attributes of corners say of a point of a surface.

/// The attributes at a point: its triangle's, interpolated. Spheres and triangles without
/// attributes have these.
struct PointAttributes {
    glm::dvec2 uv[2] = {glm::dvec2(0.0), glm::dvec2(0.0)};
    glm::dvec4 color{1.0};
};

/// b1, b2: barycentric weights of the second and third corner.
PointAttributes attributesAt(const Scene& scene, uint32_t triangle, double b1, double b2);

/// The texture that a material has in a slot, or null.
const TextureUse* textureIn(const Material& material, TextureSlot slot);

/// Decoded: linear. x and y lie within the picture.
glm::dvec4 texelAt(const TextureImage& image, bool srgb, uint32_t x, uint32_t y);

/// Decoded and filtered. Coordinates that are not finite, or beyond 2^24 (where floats have no
/// fractions), count as 0 where they are not clamped.
glm::dvec4 lookUp(const Scene& scene, const TextureUse& use, const PointAttributes& at);

/// How red grows along the texture coordinates: the derivative of what lookUp() gives, 0 of the
/// nearest texel. Between two texels; at one of them, where there is none, of one side.
glm::dvec2 slopeOf(const Scene& scene, const TextureUse& use, const PointAttributes& at);

/// The share of light that meets the surface there: its opacity, as its alpha mode takes it.
double opacityAt(const Scene& scene, const Material& material, const PointAttributes& at);

/// How often the material's other one takes its place there.
double otherShareAt(const Scene& scene, const Material& material, const PointAttributes& at);

/// Radiance that the surface emits there where it is there.
glm::dvec3 emissionAt(const Scene& scene, const Material& material, const PointAttributes& at);

/// The tangent at a corner of a triangle, as VertexAttributes has it. Where the mesh states none,
/// along u on the triangle's plane, and the bitangent against v, which grows downwards in pictures
/// (glTF); w = 0 if the texture coordinates of that set have no directions.
glm::vec4 tangentAtCorner(const Scene& scene, uint32_t triangle, uint32_t corner, uint32_t uvSet);
/// The set by which a material's tangents go: that of its normal map, or of its anisotropy.
uint32_t uvSetOfTangents(const Material& material);

} // namespace stromboli
