// What the scene looks like to the kernel: structures in 16-byte rows (a vec3 and a scalar share
// a row). The kernel fetches rows and decodes them (shaders/include/fetch.glsl); a test writes
// every field back.
#ifndef STROMBOLI_SHARED_SCENE_TYPES_H
#define STROMBOLI_SHARED_SCENE_TYPES_H

#include "language.h"

SHARED_BEGIN

// --- Bounding volume hierarchy -------------------------------------------------------------

/// Node of the binary BVH: the boxes of both children and a reference to each. Node 0 is the
/// root. An absent child has an inverted box, which no ray hits.
struct Node {
    vec3 leftLow;
    uint left;
    vec3 leftHigh;
    uint right;
    vec3 rightLow;
    uint unused0;
    vec3 rightHigh;
    uint unused1;
};
SHARED_ROWS(Node, 4);
SHARED_OFFSET(Node, right, 28);
SHARED_OFFSET(Node, rightHigh, 48);

/// A child reference is a node index, or, with the leaf bit, a run of primitives:
/// bits 0-26 the first one, bits 27-30 their number minus one.
SHARED_CONST uint CHILD_LEAF_BIT = 0x80000000u;
SHARED_CONST uint CHILD_COUNT_SHIFT = 27u;
SHARED_CONST uint CHILD_FIRST_MASK = 0x07FFFFFFu;
SHARED_CONST uint MAX_LEAF_PRIMITIVES = 16u;
SHARED_CONST uint CHILD_NONE = 0xFFFFFFFFu;
/// Bounds of an absent child, inverted: finite, so that no arithmetic on them gives NaN.
/// 2^60; coordinates of scenes stay below it (the loader drops what does not).
SHARED_CONST float LARGEST_COORDINATE = 1.152921504606846976e18f;

/// One primitive in BVH order. Triangle: the corners. Sphere: v0 is the centre, v1.x the radius.
struct Primitive {
    vec3 v0;
    uint material;
    vec3 v1;
    uint normals; ///< into the NormalTriple buffer, or NO_NORMALS
    vec3 v2;
    uint kind; ///< PRIMITIVE_TRIANGLE or PRIMITIVE_SPHERE
};
SHARED_ROWS(Primitive, 3);
SHARED_OFFSET(Primitive, kind, 44);

SHARED_CONST uint PRIMITIVE_TRIANGLE = 0u;
SHARED_CONST uint PRIMITIVE_SPHERE = 1u;
SHARED_CONST uint NO_NORMALS = 0xFFFFFFFFu;
SHARED_CONST uint NO_PRIMITIVE = 0xFFFFFFFFu;

/// Shading normals of one triangle's corners, octahedral, two 16-bit signed fractions each
/// (Meyer et al. 2010; largest error 4e-5 rad).
struct NormalTriple {
    uint n0;
    uint n1;
    uint n2;
    uint unused;
};
SHARED_ROWS(NormalTriple, 1);

// --- Materials -----------------------------------------------------------------------------

SHARED_CONST uint MATERIAL_DIFFUSE = 0u;
SHARED_CONST uint MATERIAL_MIRROR = 1u;
SHARED_CONST uint MATERIAL_REFRACTION = 2u;
SHARED_CONST uint MATERIAL_GLASS = 3u;
SHARED_CONST uint MATERIAL_MICROFACET = 4u;

/// scene/model/material.hpp, packed. The last two rows are fetched only for the kinds that use
/// them.
struct Material {
    vec3 reflectance; ///< diffuse: albedo
    uint kind;
    vec3 emission; ///< W sr^-1 m^-2
    uint emitsBothSides;
    vec3 transmittanceOrEta; ///< refraction, glass: transmittance; microfacet: eta
    float iorOrAlpha;        ///< refraction, glass: ior; microfacet: alpha
    vec3 k;
    uint unused;
};
SHARED_ROWS(Material, 4);
SHARED_OFFSET(Material, iorOrAlpha, 44);

// --- Lights --------------------------------------------------------------------------------

SHARED_CONST uint LIGHT_QUAD = 0u;
SHARED_CONST uint LIGHT_MESH = 1u;
SHARED_CONST uint LIGHT_SPHERE = 2u;
SHARED_CONST uint LIGHT_AMBIENT = 3u;
SHARED_CONST uint LIGHT_DIRECTIONAL = 4u;
SHARED_CONST uint LIGHT_POINT = 5u;
SHARED_CONST uint LIGHT_SPOT = 6u;

/// A light as it is sampled; area lights (quad, mesh, sphere, ambient) come before delta lights.
struct Light {
    vec3 position; ///< quad: corner; sphere: centre; directional: unit vector to the light
    uint kind;
    vec3 edgeA;     ///< quad; sphere: x = radius; spot: unit vector the light travels along
    float area;     ///< quad, mesh: of one side
    vec3 edgeB;     ///< quad; point, spot: constant, linear, quadratic attenuation
    uint bothSides; ///< quad, mesh, sphere: emits on both sides
    vec3 color;     ///< radiance (quad, mesh, sphere, ambient), or as scene/model/light.hpp says
    uint upperHemisphereOnly; ///< ambient
    uint firstEntry;          ///< mesh: into the EmitterEntry buffer
    uint entryCount;
    float cosCutoff; ///< spot: cosine of half the opening angle
    float falloffExponent;
};
SHARED_ROWS(Light, 5);
SHARED_OFFSET(Light, color, 48);
SHARED_OFFSET(Light, cosCutoff, 72);

/// One column of an alias table over the triangles of an emissive mesh, by area (Walker 1977,
/// Vose 1991).
struct EmitterEntry {
    uint primitive;  ///< this column's triangle, in BVH order
    uint alias;      ///< the other triangle of this column, in BVH order
    float threshold; ///< take `primitive` where the fraction within the column is below this
    uint unused;
};
SHARED_ROWS(EmitterEntry, 1);

SHARED_END

#endif
