#pragma once

#include "host/bvh/cpu_traversal.hpp"
#include "host/core/random.hpp"
#include "host/kernel/gpu_scene.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// Light on its way from lamps, as rays that the host traces to choose how a kernel samples. Nothing
// that a picture shows follows from them but its noise, so that they need not be exact.

/// The corners of a triangle at a place in the tree.
struct PlacedCorners {
    glm::dvec3 v0, v1, v2;

    double area() const { return 0.5 * glm::length(glm::cross(v1 - v0, v2 - v0)); }
    glm::dvec3 normal() const { return glm::normalize(glm::cross(v1 - v0, v2 - v0)); }
};

/// Nothing of spheres.
std::optional<PlacedCorners> placedCorners(const WideLayout& bvh, uint32_t place);

struct PlacedSphere {
    glm::dvec3 center;
    double radius;
};

PlacedSphere placedSphere(const WideLayout& bvh, uint32_t place);

/// Lets a ray go on behind what it has met.
void goThrough(const WideLayout& bvh, TraversalRay& ray, const TraversalHit& hit);

/// Of the primitive at a place in the tree.
gpu::MaterialHeader materialAtPlace(const GpuScene& scene, uint32_t place);

/// Whether light goes through it in one direction, bent or straight.
bool isClearAtPlace(const GpuScene& scene, uint32_t place);
/// The scene's material of it, as a number of Scene::materials.
uint32_t materialNumberAt(const Scene& scene, const WideLayout& bvh, uint32_t place);

/// What light starts from: a parallelogram, a triangle or a sphere.
struct Lamp {
    glm::dvec3 corner{0}, edgeA{0}, edgeB{0};
    double radius = 0; ///< of a sphere about `corner`; 0: it is none
    bool isTriangle = false, bothSides = false;
    double power = 0; ///< luminous, up to a factor that all lamps have
};

/// An emissive triangle or sphere at a place in the tree.
Lamp lampAtPlace(const GpuScene& scene, uint32_t place);

/// The lamp that a light that is sampled is, by its number; nothing if it has no surface.
std::optional<Lamp> lampOfLight(const GpuScene& scene, uint32_t number);

/// The lights with a surface that are sampled.
std::vector<Lamp> sampledLamps(const GpuScene& scene);

/// These, and the lamps that are left to bounces.
std::vector<Lamp> lampsOf(const GpuScene& scene);

/// A point of a lamp, uniform by area.
struct LampPoint {
    glm::dvec3 point, normal; ///< unit: of the side that shines, by chance if both do
};
LampPoint pointOf(const Lamp& lamp, Random& random);

/// A ray of a lamp's light, by its area and the cosine.
TraversalRay leaveLamp(const Lamp& lamp, Random& random);

/// As many rays of each lamp as it has of the power, so that each carries as much; about `count`.
std::vector<TraversalRay> raysOfLamps(std::span<const Lamp> lamps, size_t count, Random& random);

/// A direction by the cosine about a unit vector.
glm::vec3 aboutNormal(const glm::dvec3& n, Random& random);

/// Light that has landed on a primitive.
struct Landed {
    uint32_t place = gpu::NO_PRIMITIVE; ///< NO_PRIMITIVE: it has not, or on a lamp
    float b1 = 0, b2 = 0;
    glm::dvec3 point{0}, normal{0}; ///< unit, to where it comes from
};

/// A ray of light, which goes straight through glass.
struct LightPath {
    /// The glass about the lamp that it has gone through, where it has left it: the last of several
    /// surfaces of which each is at most four times as far as the one before.
    Landed glass;
    Landed surface; ///< where it ends
};

LightPath followLight(const GpuScene& scene, const TraversalRay& ray);

/// For each primitive of the scene (triangles, then spheres) whether it belongs to a lamp in clear
/// glass: most of its light meets that first, and the rest something that is no farther, such as
/// its socket. Light samples, whose rays end at glass, find no light of it but from within the
/// glass. Empty: there is none.
std::vector<bool> lampsInGlass(const Scene& scene, const WideLayout& bvh);

} // namespace stromboli
