#pragma once

#include "tests/hard_cases/naive_subject.hpp"

namespace stromboli::test::naive {

// What the naive path tracer makes of textures, principled materials and environments.

/// Emission at a hit: the nearest texel at the first corner's coordinates.
glm::vec3 emissionAt(const Scene& scene, const Hit& hit);

/// The shading normal that a normal map leaves, not turned towards anyone.
glm::vec3 mappedNormal(const Scene& scene, const Hit& hit);

/// Radiance from that direction: the nearest texel.
glm::vec3 skyAlong(const Environment& sky, const glm::vec3& direction);

struct SkySample {
    glm::vec3 direction{0.0f};
    glm::vec3 value{0.0f}; ///< radiance over density
};
/// A texel by its radiance, as if all were of one size.
SkySample sampleSky(const Environment& sky, Random& random);

/// A half vector of GGX's distribution about the normal n.
glm::vec3 halfVector(const glm::vec3& n, float alpha, float u, float v);
/// What a white metal's direction weighs, with a least denominator against fireflies.
float metalWeight(const glm::vec3& n, const glm::vec3& wo, const glm::vec3& wi,
                  const glm::vec3& half, float alpha);

} // namespace stromboli::test::naive
