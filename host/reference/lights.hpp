#pragma once

#include "host/reference/environment.hpp"
#include "host/reference/random.hpp"
#include "host/reference/surface.hpp"
#include "scene/model/emitters.hpp"

#include <vector>

namespace stromboli::reference {

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
    /// index < deltaCount().
    LightSample sampleDelta(size_t index, const SurfacePoint& surface) const;
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

} // namespace stromboli::reference
