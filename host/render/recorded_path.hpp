#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// No primitive, or no placement.
inline constexpr uint32_t kNotNamed = 0xFFFFFFFFu;

/// RecordedLight::kind of a sample that was taken of no light, as some are
/// (HowLightsArePicked::none), and as all are where none can arrive.
inline constexpr const char* kNoLight = "none";

/// A sample of direct light, or a direction in which hemisphere sampling looks for some.
struct RecordedLight {
    enum class Fate {
        BringsNothing, ///< dark, or not scattered: no ray is traced
        InShadow,
        Arrives,
    };
    std::string kind;               ///< of light; empty: whatever lies there; kNoLight
    uint32_t primitive = kNotNamed; ///< the emissive one, where it is known
    glm::dvec3 direction{0, 0, 1};  ///< unit, to the light
    /// Metres, from where the surface is lit: smooth ones are beside their triangles.
    double distance = std::numeric_limits<double>::infinity();
    /// Density by solid angle, of all samples of the point together, the choice of the light
    /// included; 0: a delta light, or not known.
    double pdf = 0;
    double probability = 0; ///< of the choice of a delta light, times the number of samples
    double weight = 1;      ///< MIS
    Fate fate = Fate::BringsNothing;
    glm::dvec3 light{0.0}; ///< what the sample's radiance gains
};

/// How a path goes on.
struct RecordedBounce {
    glm::dvec3 direction{0, 0, 1}; ///< unit
    uint32_t lobe = 0;             ///< one gpu::LOBE_ bit
    double pdf = 0;                ///< by solid angle; 0: of a delta lobe
    glm::dvec3 throughput{0.0};    ///< after it, roulette by throughput included
    double goesOn = 1;             ///< the probability of that roulette ...
    bool survives = true;          ///< ... and what came of it; false also where nothing is left
    double weight = 1;             ///< on top of its BSDF's, where bounces aim
};

/// Where a ray of a path ends.
struct RecordedVertex {
    enum class Met { Surface, Medium, Nothing };
    Met met = Met::Nothing;
    uint32_t branch = 0;  ///< from 1; 0: of the part that all branches share
    bool returns = false; ///< the point once more where the path has split, which the branch leaves
    /// In the scene's order (triangles, then spheres), and the placement of a prototype's triangle.
    uint32_t primitive = kNotNamed, placement = kNotNamed;
    glm::dvec3 position{0.0};
    double distance = std::numeric_limits<double>::infinity(); ///< of the ray, metres
    glm::dvec3 direction{0, 0, 1};                             ///< unit: of the ray
    glm::dvec3 throughput{1.0};                                ///< as the ray arrives
    double weight = 1; ///< MIS, of the light that the ray has found
    double aimedWeight =
        1; ///< of the bounce that has arrived, where bounces aim; part of throughput
    glm::dvec3 light{0.0}; ///< emission or sky: what the sample's radiance gains
    double goesOn = 1;     ///< the probability of roulette of a fixed probability
    std::vector<RecordedLight> lights;
    std::optional<RecordedBounce> bounce; ///< empty: the path ends here
};

/// The path of one sample.
struct RecordedPath {
    glm::dvec3 origin{0.0}, direction{0, 0, -1}; ///< of the camera ray
    double tMin = 0;                             ///< what is nearer is not met
    double filterWeight = 1;                     ///< by the pixel filter
    uint32_t branches = 1;
    std::vector<RecordedVertex> vertices; ///< branch after branch
    bool isWhole = true;                  ///< false: later vertices had no room
    glm::dvec3 radiance{0.0};             ///< of the sample, filter weight included
    bool rejected = false;                ///< not finite, negative or too large for a film
};

/// The radiance that the vertices add up to; it differs from the sample's by rounding, and by what
/// media shine along the way.
glm::dvec3 sumOf(const RecordedPath& path);

/// Takes a sample by itself, and tells all of its path: a backend, for the picture that it was made
/// for.
class PathRecorder {
  public:
    virtual ~PathRecorder() = default;
    /// Sample number `sample` of a pixel, to the last bit as Backend::sample() takes it. Of the
    /// integrator Path (std::invalid_argument).
    virtual RecordedPath record(uint32_t pixel, uint32_t sample) = 0;
};

} // namespace stromboli
