#pragma once

#include "host/reference/world.hpp"
#include "host/render/estimator.hpp"

namespace stromboli::reference {

/// One sample of a pixel (docs/estimator.md), in the order of that page.
class PathSample {
  public:
    /// All three must outlive the object.
    PathSample(const World& world, const Estimator& settings, const RandomStream& random);

    /// The radiance the camera ray brings back. To be called once.
    glm::dvec3 radiance(const Ray& cameraRay);
    /// 0.5 n + 0.5 of the shading normal at the first hit; 0 for a miss.
    glm::dvec3 normalColor(const Ray& cameraRay);
    /// The distance of the first hit; 0 for a miss.
    glm::dvec3 depth(const Ray& cameraRay);
    /// Rays traced so far.
    uint64_t rays() const { return rays_; }

  private:
    /// The path from the current surface on, where it is scattered for the `bounce`-th time.
    /// splits: into branches, at the first surface that scatters at random.
    void follow(uint32_t bounce, bool splits);
    /// All branches of a path that splits at the current surface.
    void followBranches(uint32_t bounce);
    /// Scattering number `bounce` and the ray after it; false if the path ends.
    bool scatter(uint32_t bounce);
    /// Traces a path ray and, if it hits, makes that point the current surface.
    bool arrive(const Ray& ray, Skip skip);
    bool arriveFromCamera(const Ray& ray);
    bool arriveAt(const Ray& ray, const Hit& hit);
    /// Whether a light sample in this direction is for the side that is looked at; where it starts,
    /// what it cannot hit, and what it goes through.
    bool isOfSide(const glm::dvec3& direction) const;
    bool looksBehind() const;
    Ray leaveTo(const glm::dvec3& direction) const;
    uint32_t startOfLightSample() const;
    const Material* mediumBeyond(bool transmitted) const;
    /// The first hit that is there: of what is partly there, decided at random.
    Hit closest(const Ray& ray, Skip skip);
    /// The share of light that comes through to the end of the ray.
    double shareThatPasses(const Ray& ray, Skip skip) const;
    void addEmission();
    bool emissionCounts(uint32_t bounce, bool delta) const;
    bool survivesFixed();
    bool survivesThroughput(uint32_t bounce);
    void addDirectLight();
    /// From the side that the surface faces; what is transmitted, from the other one.
    void addDirectLightOfSide();
    void addBroadLights();
    void addDeltaLights();
    void addHemisphereSamples();
    void addLightSample(const LightSample& light, double share);

    const World& world_;
    const Estimator& settings_;
    RandomStream random_;
    RandomStream passes_; ///< for surfaces that are partly not there
    SurfacePoint surface_;
    /// Whose inside the path is in, and which absorbs; null: nothing does.
    const Material* medium_ = nullptr;
    /// The surface as light samples see it: of the side that they go to.
    SurfacePoint lit_;
    glm::dvec3 throughput_{1.0}, radiance_{0.0};
    uint64_t rays_ = 0;
};

} // namespace stromboli::reference
