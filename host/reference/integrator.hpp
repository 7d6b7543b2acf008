#pragma once

#include "host/reference/bsdf.hpp"
#include "host/reference/bvh.hpp"
#include "host/reference/crossing.hpp"
#include "host/reference/lights.hpp"
#include "host/render/estimator.hpp"
#include "host/render/layers.hpp"
#include "host/render/recorded_path.hpp"
#include "scene/model/light_foci.hpp"

#include <algorithm>
#include <vector>

namespace stromboli::reference {

// --- The world -----------------------------------------------------------------------------------

/// What paths are traced through. Refers to the scene, which must outlive it.
struct World {
    const Scene& scene;
    ShadingConventions conventions;
    Bvh bvh;
    Lights lights;
    bool hasDetails; ///< materials have textures, or corners have attributes
    bool hasAlpha;   ///< some surface may be partly not there, or hidden from the camera
    bool mediaShine; ///< a medium emits light
    bool hasWalks;   ///< a medium lies under a surface
    std::vector<double> mostExtinction; ///< by medium of the scene (medium.hpp)
    LightFoci foci;                     ///< about which distances in media are drawn

    World(const Scene& s, const ShadingConventions& c);
};

// --- What rays pass and what they see (seeing.cpp) -----------------------------------------------

/// Whether rays straight from the camera pass the surface at a hit.
bool isHiddenFromCamera(const Scene& scene, const Hit& hit);
/// The share of light that meets the surface at a hit.
double opacityAt(const World& world, const Hit& hit);

/// The first hit that is there: of what is partly there, decided by numbers of `passes`.
Hit closestThere(const World& world, const Ray& ray, Skip skip, RandomStream& passes);
/// The first hit of a camera ray that is there; it passes what is hidden from the camera.
Hit closestForCamera(const World& world, const Ray& ray, RandomStream& passes);

/// Adds what one camera ray of a pixel sees (docs/guide/layers.md). `random`: the stream of its
/// sample, as the camera has left it; weight: by the pixel filter.
void addSeen(SeenPixel& pixel, const World& world, const Ray& cameraRay, uint32_t medium,
             double weight, RandomStream random, Seeing what);

// --- Paths ---------------------------------------------------------------------------------------

/// Beer and Lambert's law in a volume, if there is one. The distance may be infinite.
glm::dvec3 transmittance(const Material* volume, double distance);

/// One sample of a pixel (docs/theory/estimator.md), in the order of that page.
class PathSample {
  public:
    /// All three must outlive the object.
    PathSample(const World& world, const Estimator& settings, const RandomStream& random);

    /// The radiance the camera ray brings back. To be called once.
    /// medium: of the scene, around the camera; or kNoMedium.
    glm::dvec3 radiance(const Ray& cameraRay, uint32_t medium = kNoMedium);
    /// 0.5 n + 0.5 of the shading normal at the first hit; 0 for a miss.
    glm::dvec3 normalColor(const Ray& cameraRay);
    /// The distance of the first hit; 0 for a miss.
    glm::dvec3 depth(const Ray& cameraRay);
    /// From here on vertices are noted there (recording.cpp). It must outlive the object.
    void recordTo(RecordedPath& path) { record_ = &path; }
    /// Follows the path that the kernel has taken, by its directions, densities and decisions, and
    /// works out in double precision what it meets and brings (retracing.cpp): in scenes without
    /// media, by the default conventions.
    RecordedPath retrace(const RecordedPath& taken);

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
    /// Traces a path ray and, if it hits, or scatters in a medium, makes that point the current
    /// surface.
    bool arrive(const Ray& ray, Skip skip);
    bool arriveFromCamera(const Ray& ray);
    bool arriveAt(const Ray& ray, const Hit& hit);
    /// Traces as arrive() does, through media, from one surface that is passed to the next.
    bool travel(const Ray& ray, Skip skip, bool fromCamera);
    /// Whether the ray scatters in the medium that it is in, between two distances.
    bool scattersInMedium(const Ray& ray, double from, double to);
    /// Whether a light sample in this direction is for the side that is looked at; where it starts,
    /// what it cannot hit, and what it goes through.
    bool isOfSide(const glm::dvec3& direction) const;
    bool looksBehind() const;
    Ray leaveTo(const glm::dvec3& direction) const;
    uint32_t startOfLightSample() const;
    Filling beyond(bool transmitted) const;
    /// The first hit that is there: of what is partly there, decided at random.
    Hit closest(const Ray& ray, Skip skip);
    /// The share of light that comes through to the end of the ray, which begins in that filling.
    glm::dvec3 shareThatPasses(const Ray& ray, Skip skip, Filling filling) const;
    /// The share of the light that the ray after this scattering finds that adds to the picture.
    glm::dvec3 shareFound(uint32_t bounce, const BsdfSample& next) const;
    /// Whether the path has come under a surface, so that a scattering there does not
    /// count.
    bool isUnderSurface() const { return filling_.medium && filling_.medium->isUnderSurface; }
    /// The number of a scattering that follows number `bounce`.
    uint32_t numberAfter(uint32_t bounce) const { return isUnderSurface() ? bounce : bounce + 1; }
    bool survivesFixed();
    bool survivesThroughput(uint32_t bounce);
    void addDirectLight();
    /// From the side that the surface faces; what is transmitted, from the other one.
    void addDirectLightOfSide();
    void addBroadLights();
    void addDeltaLights();
    void addHemisphereSamples();
    /// f: what the surface scatters of it.
    void addLightSample(const LightSample& light, const glm::dvec3& f);
    /// Light that was scattered so many times: no more than Estimator::indirectLimit of it.
    glm::dvec3 limited(const glm::dvec3& light, uint32_t scatterings) const;

    // Where the path is recorded; else these do nothing.
    void noteArrival(const Ray& ray, bool hits, const glm::dvec3& light);
    void noteLight(const LightSample& light, RecordedLight::Fate fate, const glm::dvec3& brings);
    void noteBounce(const BsdfSample& next, double goesOn, bool survives);
    void noteReturn();

    // Of retrace().
    bool arriveWhere(const RecordedVertex& vertex, const Ray& ray, Skip skip, bool fromCamera);
    glm::dvec3 emissionWhere(const Ray& ray, double distance, uint32_t& emitter) const;
    glm::dvec3 lightThroughGlass(Ray ray, Skip skip) const;
    void retraceLight(const RecordedLight& taken);
    void retraceBounce(const RecordedBounce& taken, Ray& ray, Skip& skip);

    const World& world_;
    const Estimator& settings_;
    RandomStream random_;
    RandomStream passes_; ///< for surfaces that are partly not there
    SurfacePoint surface_;
    Filling filling_;
    uint32_t scatterings_ = 0; ///< before the path ray under way, those that count
    uint32_t uncounted_ = 0;   ///< under surfaces
    /// The surface as light samples see it: of the side that they go to.
    SurfacePoint lit_;
    glm::dvec3 throughput_{1.0}, radiance_{0.0};
    uint64_t rays_ = 0;
    RecordedPath* record_ = nullptr;
    uint32_t branch_ = 0; ///< from 1; 0: before the path has split
    double goesOn_ = 1;   ///< the probability of the roulette by throughput at the last bounce
};

} // namespace stromboli::reference
