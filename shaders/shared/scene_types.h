// What the scene looks like to the kernel: structures in 16-byte rows (a vec3 and a scalar share
// a row). The kernel fetches rows and decodes them (shaders/include/fetch.glsl); a test writes
// every field back.
#ifndef STROMBOLI_SHARED_SCENE_TYPES_H
#define STROMBOLI_SHARED_SCENE_TYPES_H

#include "bsdf_types.h"
#include "language.h"
#include "light_types.h"
#include "parameters.h"

SHARED_BEGIN

// --- Bounding volume hierarchy -------------------------------------------------------------
//
// An 8-wide tree with quantised boxes (after Ylitie, Karras and Laine 2017). Nodes and leaves are
// records of one size in one buffer, so that lanes at a node and lanes at a leaf run the same
// code. Record 0 is the root and always a node. The host packs them: host/bvh/wide_layout.hpp.

/// An inner node: the boxes of up to eight children on a grid of 256^3 cells.
/// Child s is the record firstChild + s, for those slots s that are in use; other records may lie
/// in the gaps between. Bit k of a slot number (k = 0, 1, 2 for x, y, z) is set for children on the
/// high side of axis k, so that `slot ^ octant` orders them along a ray.
/// The grid: on axis k, w = originAndExponent[k]; its upper 24 bits, the lower 8 cleared, are the
/// float `origin`, the lower 8 the exponent of `cell` = 2^(exponent - 127).
/// Box of child s on an axis: [origin + low[s] * cell, origin + high[s] * cell], low and high being
/// bytes, s = 0 in the lowest byte of the first word. The true box lies inside by BOX_MARGIN
/// cells or more (docs/theory/numerics.md derives the margin). An absent child has low = 255 and high = 0
/// on every axis.
struct NodeRecord {
    uint originAndExponentX;
    uint originAndExponentY;
    uint originAndExponentZ;
    uint firstChild; ///< < MAX_RECORDS; | RECORD_IS_NODE
    uint lowX0, lowX1, highX0, highX1;
    uint lowY0, lowY1, highY0, highY1;
    uint lowZ0, lowZ1, highZ0, highZ1;
};
SHARED_ROWS(NodeRecord, 4);
SHARED_OFFSET(NodeRecord, firstChild, 12);
SHARED_OFFSET(NodeRecord, lowX0, 16);

/// A leaf: one triangle, or two that share the edge p0 p2 and have the same orientation: slot 0 is
/// p0 p1 p2, slot 1 is p0 p2 p3 (corners may have been rotated: p0 need not be the first in the
/// file). One triangle on its own has p3 = p2: slot 1 has no area then and is never hit. A
/// sphere has its centre in all four, and its radius.
/// Triangles that are askew to the axes have several leaves, each of which is reached by a part of
/// them (host/bvh/split_items.hpp). The first is their home: all of them name it, hits are hits
/// of it, and it alone knows of lights.
/// Row 1 + slot is the slot's own: a corner, and which light the primitive is (light_types.h).
struct LeafRecord {
    vec3 p0;
    uint primitive; ///< of slot 0 in the Primitive buffer; slot 1's is the next. | RECORD_IS_SPHERE
    vec3 p1;
    uint light0; ///< of slot 0, or the sphere; NO_LIGHT: none
    vec3 p3;
    uint light1; ///< of slot 1
    vec3 p2;
    uint homeOrRadius; ///< triangles: record of the home; spheres: the radius, as a float
};
SHARED_ROWS(LeafRecord, 4);
SHARED_OFFSET(LeafRecord, primitive, 12);
SHARED_OFFSET(LeafRecord, p3, 32);
SHARED_OFFSET(LeafRecord, homeOrRadius, 60);

/// A prototype in the world (scene/model/scene.hpp), a leaf of the tree over the world: it leads into
/// the tree of the prototype, whose nodes and leaves are in the prototype's own space. That tree's
/// root is a node and its leaves hold triangles that are no lights.
struct PlacementRecord {
    uint root;      ///< record of the prototype's root
    uint transform; ///< record number of the TransformRecord
    uint placement; ///< in Scene::placements; | PLACEMENT_MIRRORS
    uint kind;      ///< RECORD_IS_PLACEMENT
    /// Rows of the matrix from the world, without an offset: what it turns is the difference to the
    /// prototype's origin in the world. In w, by how much planes of boxes move across that axis for
    /// each unit of length in the world (docs/theory/numerics.md, "Instances").
    vec4 toPrototype0, toPrototype1, toPrototype2;
};
SHARED_ROWS(PlacementRecord, 4);

/// The other half of a placement; no node or placement has it for a child.
struct TransformRecord {
    vec4 toWorld0, toWorld1, toWorld2; ///< rows of the matrix from the prototype's space
    float reach; ///< that length is this much more than from the ray's to the prototype's origin
    uint unused0, unused1, unused2;
};
SHARED_ROWS(TransformRecord, 4);

SHARED_CONST uint RECORD_ROWS = 4u;
SHARED_CONST uint RECORD_IS_NODE = 0x80000000u;   ///< in word 3
SHARED_CONST uint RECORD_IS_SPHERE = 0x40000000u; ///< in word 3
SHARED_CONST uint RECORD_IS_PLACEMENT = 0xC0000000u; ///< in word 3; both bits
SHARED_CONST uint PLACEMENT_MIRRORS = 0x80000000u;
/// The root is never a placement.
SHARED_CONST uint NO_PLACEMENT = 0u;
SHARED_CONST uint RECORD_INDEX_MASK = 0x3FFFFFFFu;
SHARED_CONST uint MAX_RECORDS = 0x40000000u; ///< 2^30: their rows are numbered in 32 bits
/// Trees of at most so many records keep a group of children in one word (traversal_stack.glsl).
SHARED_CONST uint SMALL_TREE_RECORDS = 0x01000000u;
SHARED_CONST uint WIDE_CHILDREN = 8u;
/// In cells: what a plane's distance along a ray can lose to the rounding of 255 cells,
/// 8 * 255 * 2^-24 < 2^-13 (docs/theory/numerics.md).
SHARED_CONST float BOX_MARGIN = 0.0001220703125f;
/// Coordinates of scenes stay below 2^60 (the loader drops what does not), so that no
/// arithmetic on them overflows.
SHARED_CONST float LARGEST_COORDINATE = 1.152921504606846976e18f;

/// Names a primitive where it lies in the tree: 2 * record + slot, of its home.
SHARED_CONST uint NO_PRIMITIVE = 0xFFFFFFFFu;

/// What a hit needs beside the geometry. Normals of a smooth triangle: of the corners, octahedral, two
/// 16-bit signed fractions each (Meyer et al. 2010; largest error 4e-5 rad). Of a flat one: x, y and z of
/// its unit normal as floats, so that a hit need not compute it. Of a sphere: 0.
struct Primitive {
    uint material; ///< its first row in the material buffer; | PRIMITIVE_IS_SMOOTH
    uint n0, n1, n2;
};
SHARED_ROWS(Primitive, 1);
SHARED_CONST uint PRIMITIVE_IS_SMOOTH = 0x80000000u;

SHARED_END

#endif
