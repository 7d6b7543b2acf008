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

enum class LightKind : uint32_t { Quad, Mesh, Sphere, Ambient, Directional, Point, Spot };

/// As gpu::Light.
struct Light {
    LightKind kind;
    Vec3 position, edgeA, edgeB;
    Vec3 normal; ///< quad; unit
    float area, radius;
    Vec3 color;
    bool bothSides, upperHemisphereOnly;
    uint32_t firstColumn, columnCount;
    float attenuation[3];
    float cosCutoff, falloffExponent;
};

struct LampTriangle {
    Vec3 corner, edgeA, edgeB;
    Vec3 normal; ///< unit
    Vec3 emission;
    bool bothSides;
};

/// Of the alias table of an emissive mesh; indices of LampTriangles.
struct LampColumn {
    float threshold;
    uint32_t own, alias;
};

/// As gpu::LightNode, decoded.
struct LightNode {
    Vec3 center;
    float radius;
    Vec3 axis; ///< unit
    float cosSpread, power;
    uint32_t child, count; ///< count: of a leaf's columns; 0: not a leaf
    bool bothSides;
};

/// How a triangle of a mesh light is picked: as gpu::LIGHT_CHOICE_...
enum class LightChoice : uint32_t { Area, Tree, Power, Uniform };

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
    const Light* lights; ///< area lights first
    const LampTriangle* lampTriangles;
    const LampColumn* lampColumns;
    const LightNode* lightNodes; ///< LightChoice::Tree
    LightChoice lightChoice;
    uint32_t areaLights, deltaLights;
    uint32_t width, height, seed, minBounce, maxBounces, lightSamples;
    bool sobol;       ///< the sampler; independent else
    bool lightsShare; ///< the first light sample shares the random numbers of the path ray
    Roulette roulette;
    float terminationProbability;
    View view;
};

/// What paths must be able to do: each set is compiled on its own, as the kernel is.
inline constexpr uint32_t kHasSpheres = 1, kHasNormals = 2, kHasDeltaSurfaces = 4,
                          kHasOtherLights = 8; ///< than quads
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
