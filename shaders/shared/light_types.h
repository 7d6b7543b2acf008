// Lights as the kernel reads them: their own parameters, and what one of them is picked by.
//
// Every light has a number, its LightEntry. It refers either to a run of LIGHT_ROWS rows in the light
// buffer (a LightHeader, then the parameters of its kind), or, for an emissive triangle, to its place in
// the tree: its corners are those of the leaf, its emission that of the material.
#ifndef STROMBOLI_SHARED_LIGHT_TYPES_H
#define STROMBOLI_SHARED_LIGHT_TYPES_H

#include "language.h"

SHARED_BEGIN

// --- Kinds of light and their parameters -----------------------------------------------------

SHARED_CONST uint LIGHT_QUAD = 0u;
SHARED_CONST uint LIGHT_TRIANGLE = 1u;
SHARED_CONST uint LIGHT_SPHERE = 2u;
SHARED_CONST uint LIGHT_AMBIENT = 3u;
SHARED_CONST uint LIGHT_DIRECTIONAL = 4u;
SHARED_CONST uint LIGHT_POINT = 5u;
SHARED_CONST uint LIGHT_SPOT = 6u;
SHARED_CONST uint LIGHT_ENVIRONMENT = 7u;
SHARED_CONST uint LIGHT_PROJECTOR = 8u;
SHARED_CONST uint LIGHT_KIND_COUNT = 9u;
/// Kinds that no ray can meet, bit by bit.
SHARED_CONST uint DELTA_LIGHTS = 1u << 4u | 1u << 5u | 1u << 6u | 1u << 8u;

SHARED_CONST uint LIGHT_ROWS = 4u;

struct LightHeader {
    vec3 color; ///< radiance (quad, sphere, ambient), or as scene/model/light.hpp says
    uint kind;  ///< LIGHT_ kind; | LIGHT_BOTH_SIDES, LIGHT_IS_MIRRORED, LIGHT_IS_FRAMED
};
SHARED_ROWS(LightHeader, 1);
SHARED_CONST uint LIGHT_KIND_MASK = 0xFFu;
/// Projector: acrossV x acrossU points along its axis, not acrossU x acrossV; it has a frame.
SHARED_CONST uint LIGHT_IS_MIRRORED = 0x40000000u;
SHARED_CONST uint LIGHT_IS_FRAMED = 0x20000000u;
SHARED_CONST uint LIGHT_BOTH_SIDES = 0x80000000u; ///< quad, sphere: emits on both sides

/// A parallelogram. Its normal is edgeA x edgeB.
struct QuadLight {
    vec3 corner;
    float area; ///< of one side
    vec3 edgeA;
    uint unused0;
    vec3 edgeB;
    uint unused1;
};
SHARED_ROWS(QuadLight, 3);

/// All of a scene's ambient light is one, the first in the light buffer: radiance `color` from everywhere, and
/// some from above the horizon.
struct AmbientLight {
    vec3 fromAbove; ///< radiance in addition from directions with y > 0
    uint unused;
};
SHARED_ROWS(AmbientLight, 1);

/// A picture around the scene (scene/model/environment.hpp); it takes the place of ambient light. The header's
/// colour multiplies its radiance.
struct EnvironmentLight {
    uint width, height;
    float cosRotation, sinRotation;
    float density; ///< of a sample by solid angle, where the interpolated weight is the sine of the polar angle
    uint unused0, unused1, unused2;
};
SHARED_ROWS(EnvironmentLight, 2);

/// A texel of the environment, in rows from the top. Its weight is the luminance times the sine of the polar angle
/// of its middle; it is a column of an alias table by weight (Walker 1977, Vose 1991).
/// Radiance: three mantissas of 18 bits, from the lowest on, and an exponent: m 2^(exponent - 145).
struct EnvironmentTexel {
    float threshold; ///< below this fraction of the column its own texel is taken,
    uint alias;      ///< above it this one
    uint low, high;
};
SHARED_ROWS(EnvironmentTexel, 1);
SHARED_CONST uint ENVIRONMENT_MANTISSA_BITS = 18u;
SHARED_CONST uint ENVIRONMENT_EXPONENT_BIAS = 145u;

struct SphereLight {
    vec3 center;
    float radius;
};
SHARED_ROWS(SphereLight, 1);

struct DirectionalLight {
    vec3 toLight; ///< unit
    uint unused;
};
SHARED_ROWS(DirectionalLight, 1);

/// A point light, or a spot light: a point light that shines into a cone.
struct PointLight {
    vec3 position;
    float falloffExponent; ///< spot: of the cosine to the axis
    vec3 attenuation;      ///< constant, linear and quadratic
    float cosCutoff;       ///< spot: cosine of half the opening angle
    vec3 axis;             ///< spot: unit vector that the light travels along
    float softness;        ///< spot: 1 / (cosine of half the inner angle - cosCutoff); 0: no inner cone
};
SHARED_ROWS(PointLight, 3);

/// A light that throws a picture (scene/model/light.hpp).
struct ProjectorLight {
    vec3 position;
    float cosCutoff; ///< of the angle to the axis where it ends
    vec3 acrossU;    ///< u is 0.5 + acrossU . d / axis . d
    float softness;  ///< 1 / the angle over which it ends; 0: at once
    vec3 acrossV;
    uint picture; ///< first row of its TextureUse in the material buffer; 0: none
};
SHARED_ROWS(ProjectorLight, 3);

// --- Picking one light --------------------------------------------------------------------------
// The table of lights holds all LightEntry rows, and behind them either AliasColumn rows, one for each
// light, or the nodes of the light tree.

/// What a light's number stands for.
struct LightEntry {
    uint light;        ///< first row in the light buffer / LIGHT_ROWS, or a place | LIGHT_IS_TRIANGLE
    uint trail;        ///< light tree: bit i says which child (1: the second) the walk takes at level i
    float probability; ///< of being picked from the alias table
    uint group;        ///< light tree: LIGHT_GROUP_
};
SHARED_ROWS(LightEntry, 1);
SHARED_CONST uint LIGHT_IS_TRIANGLE = 0x80000000u;
SHARED_CONST uint NO_LIGHT = 0xFFFFFFFFu;

/// One column of an alias table over all lights (Walker 1977, Vose 1991).
struct AliasColumn {
    float threshold; ///< below this fraction of the column its own light is taken,
    uint alias;      ///< above it the light with this number
    uint unused0;
    uint unused1;
};
SHARED_ROWS(AliasColumn, 1);

/// Lights whose irradiance is bounded by power / distance^2 times cosines.
SHARED_CONST uint LIGHT_GROUP_NEAR = 0u;
/// Point and spot lights that hardly fall off within the scene: power times a cosine.
SHARED_CONST uint LIGHT_GROUP_UNATTENUATED = 1u;
/// Ambient and directional lights: power times a cosine, from within a cone of directions.
SHARED_CONST uint LIGHT_GROUP_INFINITE = 2u;
SHARED_CONST uint LIGHT_GROUP_COUNT = 3u;

/// A node of a light tree (host/kernel/light_tree.hpp): bounds of what its lights send out. Each group has a tree
/// of its own, complete but for its deepest level: node 1 is the root, the children of node i are 2 i and 2 i + 1,
/// and of n lights the leaves are the nodes n to 2 n - 1, in the order of the lights' numbers. Groups follow each
/// other; each has 2 n nodes, of which the first, number 0, is of no use.
/// The first rows of all groups' nodes follow each other, then the second ones, which are read only where some light
/// has a cone.
struct LightNode {
    vec3 center;         ///< of a sphere that holds the lights; infinite lights: of no meaning
    uint radiusAndPower; ///< the upper halves of two floats, the radius in the upper half. The power is the luminance
                         ///< of the irradiance that the lights bring at most, times distance^2 where they are near
    uint axis;           ///< of a cone that holds their normals, or directions of travel; octahedral as in Primitive
    float cosSpread;     ///< of the cone's half angle
    uint flags;          ///< LIGHT_NODE_
    uint unused;
};
SHARED_ROWS(LightNode, 2);
SHARED_CONST uint LIGHT_NODE_BOTH_SIDES = 1u; ///< some emit against their normals too
SHARED_CONST uint LIGHT_NODE_SHARP = 2u;      ///< nothing is sent out of the cone
/// More levels than any tree has: its nodes are numbered in 31 bits.
SHARED_CONST uint MOST_LIGHT_LEVELS = 30u;

SHARED_END

#endif
