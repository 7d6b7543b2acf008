#pragma once

#include <embree3/rtcore.h>

#include <cstdint>

/// The inner loops on Embree. Their source is compiled for the newest instructions that Embree
/// itself is likely to run on, and must not share inline functions with the rest of the program, so
/// this interface has plain data only.
namespace stromboli::bench::native {

struct Tracer {
    RTCScene scene;
    decltype(&rtcIntersect1) intersect;
    decltype(&rtcOccluded1) occluded;
};

// --- Rays alone --------------------------------------------------------------------------------

struct Totals {
    uint64_t hits = 0;
    double distances = 0;
};

/// rays: origin, tMax, direction, unused; eight floats each. distances: null, or where each ray
/// ended (the largest float for misses; shadow rays: 0 for hits).
Totals traceRays(const Tracer& tracer, bool anyHit, const float* rays, uint64_t first,
                 uint64_t count, float* distances);

// --- Paths ---------------------------------------------------------------------------------------

struct Vec3 {
    float x, y, z;
};

enum class SurfaceKind : uint32_t { Diffuse, Mirror, Refraction, Glass };

struct Surface {
    Vec3 reflectance; ///< diffuse: albedo
    SurfaceKind kind;
    Vec3 emission;
    uint32_t emitsBothSides;
    Vec3 transmittance;
    float ior;
};

inline constexpr uint32_t kNoNormals = 0xFFFFFFFFu;

struct TriangleShading {
    uint32_t material;
    uint32_t normal[3];
    /// How far each edge (from corner i to the next) bulges out of the plane, on the side that the
    /// geometric normal points to: the kernel's liftAt(), shaders/include/surface.glsl.
    float bulge[3];
};

struct Sphere {
    Vec3 center;
    float radius;
    uint32_t material;
};

/// As gpu::LIGHT_ kinds, decoded.
struct Light {
    uint32_t kind;
    Vec3 position; ///< quad: corner; sphere: centre; directional: unit vector to the light
    Vec3 edgeA, edgeB;
    Vec3 normal; ///< quad; unit
    float area, radius;
    Vec3 color;
    Vec3 fromAbove; ///< ambient
    bool bothSides;
    float attenuation[3];
    Vec3 axis;
    float cosCutoff, falloffExponent, softness;
};

/// An emissive triangle.
struct TriangleLight {
    Vec3 corner, edgeA, edgeB;
    Vec3 normal; ///< unit
    Vec3 emission;
    float doubleArea;
    bool bothSides;
};

/// As gpu::LightEntry.
struct LightEntry {
    bool isTriangle;
    uint32_t index; ///< into World::triangleLights or World::lights
    float probability;
};

/// As gpu::AliasColumn.
struct AliasColumn {
    float threshold;
    uint32_t alias;
};

/// As gpu::LightNode, decoded.
struct LightNode {
    Vec3 center;
    float radius;
    Vec3 axis; ///< unit
    float cosSpread, sinSpread, power;
    bool bothSides, sharp;
};

struct View {
    bool orthographic, clipAlongRay;
    Vec3 position, right, up, back; ///< right and up times half the picture's size
    float nearDistance, farDistance;
};

enum class Roulette : uint32_t { None, Throughput, Fixed };
inline constexpr uint32_t kRouletteStart = 3; ///< by throughput: the bounce it begins at
inline constexpr float kMostContinue = 0.95f;
inline constexpr float kBoldness = 3.0f;

inline constexpr uint32_t kTriangleGeometry = 0, kSphereGeometry = 1; ///< Embree's geometry numbers

/// All a path needs; arrays belong to the caller.
struct World {
    Tracer tracer;
    const Surface* surfaces;
    const TriangleShading* triangles;
    const float* normals; ///< four floats each
    const Sphere* spheres;
    const Light* lights; ///< the ambient light first
    const TriangleLight* triangleLights;
    const LightEntry* lightEntries;
    const AliasColumn* aliasColumns;
    const LightNode* lightNodes;
    uint32_t lightChoice;      ///< gpu::LIGHT_CHOICE_
    uint32_t lightsInGroup[3]; ///< of the light tree, by gpu::LIGHT_GROUP_
    uint32_t lightCount, areaLights;
    bool onlyNearWithoutCones; ///< the tree's lights: likelyLightWithoutCone() weighs them
    bool hasAmbient;           ///< then it is lights[0]
    /// What a bounce from a diffuse surface has of the ambient light that it finds, and light
    /// samples the rest of: 0 where light samples find it all, 1 where there are none of it.
    float ambientOfBounces;
    uint32_t lightSamples; ///< of all lights together, per shading point
    uint32_t samplesPerLight;
    uint32_t width, height, seed, minBounce, maxBounces;
    bool sobol; ///< the sampler; independent else
    Roulette roulette;
    float terminationProbability;
    View view;
};

/// What paths must be able to do: each set is compiled on its own, as the kernel is.
inline constexpr uint32_t kHasSpheres = 1, kHasNormals = 2, kHasDeltaSurfaces = 4,
                          kHasOtherLights = 8; ///< than one quad
inline constexpr uint32_t kFeatureSets = 16;

/// Sums over the samples of a pixel that were finite and not negative.
struct PixelSums {
    double sum[3], squares[3];
    uint32_t count, rejected, firstRejected; ///< firstRejected counts from the first sample here
    uint64_t rays;
};

/// Takes samples first, first + 1, ... of a pixel (in the whole picture).
PixelSums samplePixel(const World& world, uint32_t features, uint32_t pixel, uint32_t first,
                      uint32_t count);

/// Sets what Embree asks for in every thread that traces: denormals are zero.
void prepareThread();

} // namespace stromboli::bench::native
