// What the tests ask their shaders and what these answer, for C++ and GLSL. Rows as in
// shaders/shared: a vec3 and a scalar share 16 bytes.
#ifndef STROMBOLI_TEST_QUERIES_H
#define STROMBOLI_TEST_QUERIES_H

#include "shared/language.h"
#include "shared/render_types.h"
#include "shared/scene_types.h"

SHARED_BEGIN

/// pcg4d and unitFloats of the words, randomBlock of them in the order pixel, sample, block, seed.
struct RandomQuery {
    uint x;
    uint y;
    uint z;
    uint w;
};
struct RandomAnswer {
    uint hashed[4];
    float units[4];
    float block[4];
    float leftOver;      ///< of the block's words
    uint quotient, rest; ///< quotientAndRest(x, y)
    uint unused;
};
SHARED_ROWS(RandomAnswer, 4);

/// lookUp() of the texture whose rows begin at `row` of the material buffer.
struct TextureQuery {
    uint row;
    float u;
    float v;
    uint mapPlusOne; ///< of a bundle: slot plus one; 0: a loose texture; SLOPE_OF_TEXTURE: its
                     ///< slopeOf(); TANGENT_OF_CORNER plus 0, 1 or 2: of primitive `row` the
                     ///< cornerTangent() and, as alpha, bitangentSide()
};
SHARED_CONST uint SLOPE_OF_TEXTURE = 100u;
SHARED_CONST uint TANGENT_OF_CORNER = 101u;
struct TextureAnswer {
    vec3 color;
    float alpha;
};
SHARED_ROWS(TextureAnswer, 1);

struct TriangleQuery {
    vec3 v0;
    uint unused0;
    vec3 v1;
    uint unused1;
    vec3 v2;
    uint unused2;
    vec3 origin;
    uint unused3;
    vec3 direction;
    uint unused4;
};
SHARED_ROWS(TriangleQuery, 5);
/// The triangle as slot 0 of a leaf, then as slot 1; the other slot has no area.
struct TriangleAnswer {
    float t;
    float b1;
    float b2;
    float naive; ///< t of Moeller-Trumbore with an absolute cut-off
    float t1;
    float b11;
    float b21;
    float t2; ///< nearest of the slots without area
};
SHARED_ROWS(TriangleAnswer, 2);

struct SphereQuery {
    vec3 center;
    float radius;
    vec3 origin;
    float tMin;
    vec3 direction;
    float tMax;
};
struct SphereAnswer {
    float t;
    float naive; ///< t by b^2 - 4ac
};

/// A NodeRecord and a ray that may enter its children.
struct NodeQuery {
    uint record[16];
    vec3 origin;
    float tMax;
    vec3 direction;
    uint number; ///< for highestBit
};
SHARED_ROWS(NodeQuery, 6);
struct NodeAnswer {
    uint entered; ///< as enterChildren gives them: bit (slot ^ octant)
    uint octant;
    uint naive; ///< bit (slot) by the slab test without slack and with infinite reciprocals
    uint highest;
};

/// Primitives by their place in the tree, 2 * record + slot.
struct RayQuery {
    vec3 origin;
    float tMin;
    vec3 direction;
    float tMax;
    uint skipPrimitive;
    uint anyHit;
    uint unused0;
    uint unused1;
};
struct RayAnswer {
    float t;
    float b1;
    float b2;
    uint primitive;
    uint steps;
    uint bruteHits;    ///< of all primitives, tried one by one
    uint naiveHits;    ///< the same by Moeller-Trumbore (triangles)
    float bruteT;      ///< of the closest primitive, tried one by one
    uint highestEntry; ///< of the stack, written to
    uint bruteRecords; ///< leaves that were tried
    uint unused0;
    uint unused1;
};
SHARED_ROWS(RayAnswer, 3);

/// `count` samples for a pixel: even and odd by turns, or drawn from a distribution.
struct AccumulateQuery {
    PixelState state;
    vec3 naiveSum;
    uint count;
    vec3 even;
    uint random; ///< not 0: even / u, u the random numbers of this pixel
    vec3 odd;
    uint injectAt; ///< this sample of the query is replaced ...
    vec3 injected; ///< ... by this
    uint unused;
};
SHARED_ROWS(AccumulateQuery, 8);
struct AccumulateAnswer {
    PixelState state;
    vec3 naiveSum; ///< negative control: one float
    uint unused;
};
SHARED_ROWS(AccumulateAnswer, 5);

struct WarpQuery {
    vec3 normal; ///< of makeFrame
    float alpha;
    float u;
    float v;
    uint encodedNormal;
    uint unused;
};
SHARED_ROWS(WarpQuery, 2);
struct WarpAnswer {
    vec3 cosine;
    float diskX;
    vec3 hemisphere;
    float diskY;
    vec3 beckmann;
    float cosine4u; ///< of 4 u quarter turns ...
    vec3 frameX;
    float sine4u; ///< ... the same
    vec3 frameY;
    uint unused0;
    vec3 frameZ;
    uint unused1;
    vec3 decoded;
    uint unused2;
};
SHARED_ROWS(WarpAnswer, 7);

/// A light sample for a surface, and whether its segment is blocked by the scene.
struct LightQuery {
    vec3 position;
    uint light; ///< its number; NO_LIGHT: the kernel picks one
    vec3 error;
    uint outside;
    vec3 geometric;
    float u;
    vec3 shading;
    float v;
    vec3 wo;
    uint unused;
};
SHARED_ROWS(LightQuery, 5);
struct LightAnswer {
    vec3 target;
    uint infinite;
    vec3 direction;
    uint blocked;
    vec3 radiance;     ///< over the density and the probability of the choice
    uint light;        ///< LightEntry::light of what was sampled
    float probability; ///< of the choice, as pickLight() states it
    float again;       ///< the same, as lightProbability() states it of the light in the query
    float u;           ///< what is left of the random numbers
    float v;
};
SHARED_ROWS(LightAnswer, 4);

/// evaluateBsdf towards wi and sampleBsdf with u, v, w, on a surface that is turned to wo first.
struct BsdfQuery {
    vec3 wo;
    uint materialRow;
    vec3 wi;
    uint outside;
    vec3 geometric;
    float u;
    vec3 shading;
    float v;
    float w;
    uint material; ///< its number, for the test
    uint unused0;
    uint unused1;
};
SHARED_ROWS(BsdfQuery, 5);
struct BsdfAnswer {
    vec3 value; ///< f |cos| for wi
    float pdf;  ///< of bounces towards wi
    vec3 direction;
    float samplePdf; ///< of that direction
    vec3 weight;
    uint lobe;
};
SHARED_ROWS(BsdfAnswer, 3);

struct TermQuery {
    vec3 eta;
    float x; ///< a cosine; of erfPositive any number
    vec3 k;
    float alpha; ///< or an index of refraction
};
struct TermAnswer {
    vec3 conductor;
    float erf;
    vec3 approximateConductor;
    float lambda;
    float dielectric;
    float cosTransmitted;
    float schlick;
    float unused;
};
SHARED_ROWS(TermAnswer, 3);

/// A ray at one primitive, and a direction in which to leave the point it hits.
struct SurfaceQuery {
    vec3 origin;
    uint place; ///< 2 * record + slot
    vec3 direction;
    uint unused0;
    vec3 leaving;
    uint unused1;
};
SHARED_ROWS(SurfaceQuery, 3);
struct SurfaceAnswer {
    vec3 position;
    float t; ///< of the hit
    vec3 error;
    float again; ///< t at which the ray that leaves hits the same primitive, if it is not skipped
    vec3 geometric;
    uint outside;
    vec3 shading; ///< before faceForward
    uint skipPrimitive;
    vec3 facing; ///< the shading normal after faceForward
    float lift;
    vec3 start; ///< of the ray that leaves
    uint unused;
};
SHARED_ROWS(SurfaceAnswer, 6);

/// A bounce into the gap behind the scene's light, from a point on its other side; u, v in [0, 1).
struct GapQuery {
    vec3 position;
    float u;
    float v;
    uint unused[3];
};
SHARED_ROWS(GapQuery, 2);
struct GapAnswer {
    vec3 direction; ///< unit
    float pdf;      ///< of it, by solid angle
    float
        along0; ///< the point of the light's plane it goes through, from the corner along the edges
    float along1;
    float pdfBehind;  ///< of the opposite direction
    float pdfAtLight; ///< of the direction to the light's middle
};
SHARED_ROWS(GapAnswer, 2);

SHARED_END

#endif
