// Lights as the kernel reads them: their own parameters, and what one of them is picked by.
//
// Every light has a number, its LightEntry. It refers either to a run of LIGHT_ROWS rows in the light
// buffer (a LightHeader, then the parameters of its kind), or, for an emissive triangle, to its place in
// the tree: its corners are those of the leaf, its emission that of the material.
#ifndef STROMBOLI_SHARED_LIGHT_TYPES_H
#define STROMBOLI_SHARED_LIGHT_TYPES_H

#include "delta_lights.h"
#include "language.h"

SHARED_BEGIN

// --- Kinds of light and their parameters -----------------------------------------------------

// F(name, number, rows, label): the kinds of light, by their numbers.
//   rows   how many rows of parameters are read of it
//   label  what `stromboli info` calls it
#define LIGHT_LIST(F) \
    F(QUAD, 0, 3, "quad") \
    F(TRIANGLE, 1, 0, "triangle") \
    F(SPHERE, 2, 1, "sphere") \
    F(AMBIENT, 3, 1, "ambient") \
    F(ENVIRONMENT, 4, 2, "environment") \
    DELTA_LIGHT_LIST(F)

#define NUMBER_LIGHT(name, number, rows, label) SHARED_CONST uint LIGHT_##name = uint(number);
LIGHT_LIST(NUMBER_LIGHT)
#undef NUMBER_LIGHT
#define COUNT_LIGHT(name, number, rows, label) +1u
SHARED_CONST uint LIGHT_KIND_COUNT = 0u LIGHT_LIST(COUNT_LIGHT);
#undef COUNT_LIGHT

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

// F(type, name, row, place): the parameters of a light, in the order of their places behind its header, of which none is
// left out (parameters.h).

/// A parallelogram. Its normal is edgeA x edgeB. area: of one side.
#define QUAD_LIGHT(F) \
    F(vec3, corner, 1, xyz) \
    F(float, area, 1, w) \
    F(vec3, edgeA, 2, xyz) \
    F(uint, unused0, 2, w) \
    F(vec3, edgeB, 3, xyz) \
    F(uint, unused1, 3, w)

#define SPHERE_LIGHT(F) \
    F(vec3, center, 1, xyz) \
    F(float, radius, 1, w)

/// All of a scene's ambient light is one, the first in the light buffer: radiance `color` from everywhere, and
/// some in addition from directions with y > 0.
#define AMBIENT_LIGHT(F) \
    F(vec3, fromAbove, 1, xyz) \
    F(uint, unused, 1, w)

/// A picture around the scene (scene/model/environment.hpp); it takes the place of ambient light. The header's
/// colour multiplies its radiance. density: of a sample by solid angle, where the interpolated weight is the sine of the
/// polar angle. Its texels lie in `tiles` squares of 2^tileShift columns and rows, or what of them is in the picture,
/// numbered from the left and from the top. ROWS_REACH_POLES: the middles of the first and the last row are the poles, and
/// half of each row is left out.
#define ENVIRONMENT_LIGHT(F) \
    F(uint, width, 1, x) \
    F(uint, height, 1, y) \
    F(float, cosRotation, 1, z) \
    F(float, sinRotation, 1, w) \
    F(float, density, 2, x) \
    F(uint, tileShift, 2, y) \
    F(uint, tilesAcross, 2, z) \
    F(uint, tiles, 2, w)

// F(structure, function, fields, met, sample): how the kernel reads and samples lights (shaders/lights/lights.glsl).
//   met     GLSL: whether a light of this `kind` has that structure, by isLight()
//   sample  GLSL: a LightSample of it, for `given`, a surface `s`, its `rows` and two numbers `u`
#define LIGHT_STRUCTURES(F) \
    F(QuadLight, quadLight, QUAD_LIGHT, isLight(kind, LIGHT_QUAD), sampleQuadLight(given.onlyLight, s, rows, u)) \
    F(SphereLight, sphereLight, SPHERE_LIGHT, isLight(kind, LIGHT_SPHERE), sampleSphereLight(s, rows, u)) \
    F(AmbientLight, ambientLight, AMBIENT_LIGHT, isLight(kind, LIGHT_AMBIENT), sampleAmbientLight(given, s, rows, u)) \
    F(EnvironmentLight, environmentLight, ENVIRONMENT_LIGHT, isLight(kind, LIGHT_ENVIRONMENT), \
      sampleEnvironment(given, s, rows, u)) \
    DELTA_LIGHT_STRUCTURES(F)

/// Surfaces of clear glass that a light sample goes through at most (include/clear_glass.glsl); behind more, bounces find
/// its light alone. So a dispatch is not longer than it may be (softLimit() of host/kernel/dispatcher.cpp).
SHARED_CONST uint MOST_PANES = 12u;
/// Squared distance of two unit vectors that are the same for the sky: 2^-22, an angle of 1.7', less than a texel of most
/// skies. Flat panes and slabs keep a ray's direction but for rounding. Any limit leaves pictures without bias, since light
/// samples and bounces are asked alike.
SHARED_CONST float SAME_DIRECTION = 2.384185791015625e-7f;

#define DECLARE_FIELD(type, name, row, place) type name;
#define DECLARE_LIGHT(structure, function, fields, met, sample) \
    struct structure { fields(DECLARE_FIELD) }; \
    SHARED_WHOLE_ROWS(structure);
LIGHT_STRUCTURES(DECLARE_LIGHT)
#undef DECLARE_LIGHT
#undef DECLARE_FIELD

/// The rows of the environment: ENVIRONMENT_COLUMN_ROWS of TileColumns, then its texels.
SHARED_CONST uint ENVIRONMENT_TILES_ACROSS = 32u; ///< at most
SHARED_CONST uint ENVIRONMENT_TILES_DOWN = 16u;
SHARED_CONST uint ENVIRONMENT_TILES = ENVIRONMENT_TILES_ACROSS * ENVIRONMENT_TILES_DOWN;
SHARED_CONST uint ENVIRONMENT_COLUMN_ROWS = ENVIRONMENT_TILES / 2u;

/// Two tiles of the environment as columns of an alias table (Walker 1977, Vose 1991) of all tiles, by the sum of their
/// texels' weights, or by what guiding has learnt (guide_types.h).
struct TileColumns {
    float threshold0; ///< below this fraction of the column its own tile is taken,
    uint alias0;      ///< above it this one
    float threshold1;
    uint alias1;
};
SHARED_ROWS(TileColumns, 1);

/// A texel of the environment, in rows from the top. Its weight is the luminance times the sine of the polar angle
/// of its middle; it is a column of an alias table, by weight, of the texels of its tile.
/// Radiance: three mantissas of 18 bits, from the lowest on, and an exponent: m 2^(exponent - 145).
struct EnvironmentTexel {
    float threshold; ///< below this fraction of the column its own texel is taken,
    uint alias;      ///< above it this one
    uint low, high;
};
SHARED_ROWS(EnvironmentTexel, 1);
SHARED_CONST uint ENVIRONMENT_MANTISSA_BITS = 18u;
SHARED_CONST uint ENVIRONMENT_EXPONENT_BIAS = 145u;

/// A cell of a triangle or of a sphere that lamps light, a column of an alias table of all such cells (host/kernel/find_lit_cells.hpp).
/// A triangle's squares of barycentric weights are numbered by that of v1, then that of v2, and have two cells each, that
/// towards v0 first; a sphere has one for all of it, and one that is empty. Behind the cells, in rows of four, is for each place in the tree NO_CELLS or its first cell, above
/// CELLS_LEVEL_BITS of the power of two that a triangle's sides are divided into.
struct LitCell {
    float threshold; ///< below this fraction of the column the cell itself is taken,
    uint alias;      ///< above it this one
    uint place;
    float density; ///< of bounces that aim, by area; a sphere: of all of it, which is aimed at by solid angle
};
SHARED_ROWS(LitCell, 1);
SHARED_CONST uint CELLS_LEVEL_BITS = 4u;
SHARED_CONST uint NO_CELLS = 0xFFFFFFFFu;

/// Which cell of a triangle, divided 2^level times, the barycentric weights of v1 and v2, in [0, 1], lie in.
SHARED_FUNCTION uint cellOfWeights(float b1, float b2, uint level) {
    const float side = float(1u << level), most = side * (1.0f - 0.000244140625f);
    const float x = b1 * side < most ? b1 * side : most, y = b2 * side < most ? b2 * side : most;
    const uint i = uint(x), j = uint(y);
    const bool isUpper = (x - float(i)) + (y - float(j)) > 1.0f;
    return 2u * ((i << level) + j) + (isUpper ? 1u : 0u);
}

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
