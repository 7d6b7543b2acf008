// What all paths of a picture have in common, found once before all loops (docs/theory/kernel.md, "Nothing is moved out of
// loops") and passed to the functions that ask for it.

/// From the camera to the picture, at a distance of 1 (orthographic: 0): its top left corner, and the steps from one
/// pixel to the next.
struct PictureGrid {
    vec3 corner, right, down;
};

/// The rows of a light: its header, and three that its kind reads its parameters from (light_rows.glsl).
struct LightRows {
    uvec4 header, row1, row2, row3;
};

/// LIGHT_CHOICE_ONE: the light, if it is no triangle.
struct OnlyLight {
    LightRows rows;
    vec3 normal; ///< LIGHT_QUAD
};

/// A node of the light tree as weights are asked of it (lights/light_tree.glsl).
struct LightBounds {
    vec3 center;  ///< of a sphere that holds the lights, if they are not infinitely far,
    float radius; ///< and its radius
    float power;  ///< as LightNode has it
    vec3 axis;    ///< unit: of the cone of their normals, or directions of travel,
    vec2 spread;  ///< and cosine and sine of its half angle
    uint flags;   ///< LIGHT_NODE_
};

/// The root of a group of lights. Where each group is a single light (holdsAllLights()), all that is read of it.
struct LightRoot {
    LightBounds bounds;
    uint number; ///< of its light
    LightEntry entry;
    LightRows rows; ///< if it is no triangle
};

/// LIGHT_CHOICE_TREE, of several groups.
struct LightRoots {
    LightRoot all[LIGHT_GROUP_COUNT];
};

/// For the gap proposal (gap_proposal.glsl): the light, from the side that is not the gap's, from which one looks into
/// the gap.
struct Gap {
    vec3 corner;
    vec3 along0, along1; ///< unit vectors along the edges
    vec3 normal;         ///< unit, away from the gap
    vec2 size;           ///< of the light along the two
    float width;         ///< from the light to the surface; > 0
};

/// A rectangle that stops light samples (occluders.glsl). Of a row, dot(row.xyz, point) + row.w is a function of a point.
struct Occluder {
    vec4 plane; ///< the height above it, in units of what a ray has to go beyond on both sides
    vec4 across, along; ///< where a point of the plane is: within the rectangle in (-1, 1), both
};

struct Occluders {
    Occluder all[MOST_OCCLUDERS];
};

/// A rectangle through which a room sees the sky (lights/portals.glsl).
struct Portal {
    vec3 corner, edgeA, edgeB;
    vec2 perSquare; ///< 1 / the squares of the edges' lengths
    vec3 normal;    ///< edgeA x edgeB, into the room
    vec3 half_;     ///< from the corner to the middle,
    float reach;    ///< and how far that is
};

struct Portals {
    Portal all[MOST_PORTALS];
};

/// What a sun does not reach (shadow_map.glsl).
struct ShadowMap {
    vec4 across, along; ///< as Frame has them,
    vec3 towards;       ///< likewise
    uint firstRow;
};

struct Given {
    Frame frame;
    PictureGrid grid;
    OnlyLight onlyLight;
    LightRoots roots;
    Gap gap;
    Occluders occluders;
    ShadowMap shadow;
    Portals portals;
    LightRows sky; ///< of what rays find that meet nothing, with HAS_AMBIENT
};
