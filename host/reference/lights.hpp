#pragma once

#include "host/reference/sampling.hpp"
#include "host/reference/surface.hpp"
#include "scene/model/emitters.hpp"
#include "scene/model/environment.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::reference {

// --- The environment -----------------------------------------------------------------------------

/// The environment's radiance, and samples of it: a row and a texel in it by running sums of
/// weights, then any direction in the texel's patch of the sphere. A texel's weight is its solid
/// angle times the largest luminance among it and its neighbours, which no interpolated value in
/// it exceeds.
class EnvironmentMap {
  public:
    explicit EnvironmentMap(const Environment& environment);

    /// From a unit direction.
    glm::dvec3 radiance(const glm::dvec3& direction) const;

    struct Sample {
        glm::dvec3 direction{0, 0, 1}; ///< unit
        glm::dvec3 weight{0.0};        ///< radiance over density by solid angle
    };
    /// u: each uniform in [0, 1).
    Sample sample(const glm::dvec3& u) const;

  private:
    glm::dvec3 texel(int64_t x, int64_t y) const;
    double neighbourhoodLuminance(int64_t x, int64_t y) const;

    Environment environment_;
    std::vector<double> rowSums_, sumsInRow_;
};

// --- All lights ----------------------------------------------------------------------------------

/// A sampled way from a surface to a light.
struct LightSample {
    glm::dvec3 direction{0, 0, 1}; ///< unit, to the light
    /// Radiance over the density of the direction (solid angle); delta lights: the irradiance on a
    /// surface that faces the light. 0: nothing arrives.
    glm::dvec3 value{0.0};
    bool infinite = true;
    glm::dvec3 target{0.0};            ///< finite lights: the segment ends here, before the light
    uint32_t primitive = kNoPrimitive; ///< the emitter, which cannot hide itself
};

/// All emissive triangles of a scene that has many, as one light: picked by power.
struct ManyTriangles {
    std::vector<uint32_t> triangles;
    std::vector<double> powers;    ///< MeanEmission::powerOfTriangle()
    std::vector<double> powerSums; ///< their running sums
};

/// All a scene has to light a surface with. The lights that are not delta functions ("broad":
/// emitters, ambient light, area lights that are no emitters) get several samples each.
/// Refers to the scene, which must outlive it.
class Lights {
  public:
    /// Throws std::invalid_argument if emitters are sampled and the scene still has area lights
    /// (resolveAreaLights() turns them into emitters).
    Lights(const Scene& scene, const ShadingConventions& conventions);

    size_t broadCount() const {
        return many_.size() + emitters_.size() + ambient_.size() + environment_.size() +
               areas_.size();
    }
    size_t deltaCount() const { return delta_.size(); }
    /// Every light of the file, whatever its kind.
    size_t fileCount() const { return scene_.lights.size(); }

    /// index < broadCount(). The surface is faced forward.
    LightSample sampleBroad(size_t index, const SurfacePoint& surface, RandomStream& random) const;
    /// index < deltaCount(). None of today's takes a random number; a kind that does is a matter of
    /// lights.cpp alone.
    LightSample sampleDelta(size_t index, const SurfacePoint& surface, RandomStream& random) const;
    /// What ambient lights and the environment send to a ray with this direction that hits nothing.
    glm::dvec3 ambientRadiance(const glm::dvec3& direction) const;
    /// What the camera sees where it sees nothing of the scene: the environment.
    glm::dvec3 backdrop(const glm::dvec3& direction) const;

  private:
    LightSample sampleMany(const SurfacePoint& surface, RandomStream& random) const;
    LightSample sampleEmitter(size_t index, const SurfacePoint& surface,
                              RandomStream& random) const;
    LightSample sampleAmbient(const Light& light, const SurfacePoint& surface,
                              RandomStream& random) const;

    const Scene& scene_;
    ShadingConventions conventions_;
    std::vector<ManyTriangles> many_; ///< one, or none
    std::vector<Emitter> emitters_;
    std::vector<std::vector<double>> areaSums_; ///< of each mesh emitter: running sums of areas
    std::vector<EnvironmentMap> environment_;   ///< one, or none
    std::vector<const Light*> ambient_, areas_, delta_;
};

// --- Emitters ------------------------------------------------------------------------------------

/// A triangle of a mesh that emits.
struct EmitterTriangle {
    glm::dvec3 v0, v1, v2;
    double area; ///< of one side
    uint32_t index;
    const Scene* scene;

    EmitterTriangle(const Scene& scene, uint32_t index);
    /// What it sends out at a point of it, on a side that emits: its texture and its opacity count.
    glm::dvec3 emissionAt(const glm::dvec3& point) const;
};

// Samples of one emitter each, from a surface at `from`.

/// Uniform by direction: density `probability`, that of picking this triangle, over its solid
/// angle. Nothing from a surface in the triangle's plane, whose distance is rounding.
LightSample sampleTriangle(const EmitterTriangle& triangle, double probability,
                           const Material& material, const SurfacePoint& surface,
                           RandomStream& random);

/// Steradians that the triangle takes up as seen from a point; 0 in its plane.
double solidAngle(const EmitterTriangle& triangle, const glm::dvec3& from);

/// From outside uniform in the cone the sphere subtends (Shirley, Wang and Zimmerman 1996), from
/// inside uniform on its area. A surface point on the sphere itself is on the side wo is on.
LightSample sampleSphere(const Scene& scene, const Emitter& emitter, const SurfacePoint& surface,
                         RandomStream& random);

/// Uniform on the rectangle, falling off with the distance or its square; only the side that the
/// light's direction points to emits.
LightSample sampleRectangle(const Light& light, const glm::dvec3& from,
                            const ShadingConventions& conventions, RandomStream& random);

} // namespace stromboli::reference
