#pragma once

#include "host/render/settings.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace stromboli::reference {

// --- Random numbers ------------------------------------------------------------------------------

/// Ten rounds of Philox 4x32: Salmon, Moraes, Dror and Shaw, "Parallel Random Numbers: As Easy as
/// 1, 2, 3" (SC 2011). A bijection of the counter for every key.
std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key);

/// The random numbers of one sample of one pixel: a pure function of (pixel, sample, seed), so
/// that neither threads nor passes change a picture. They come in blocks of four. Blocks never
/// overlap, because their Philox counters are distinct; with Sampler::Sobol, a block's numbers over
/// the samples of a pixel are a sequence that fills the unit cube evenly
/// (docs/theory/estimator.md), and different blocks are independent.
class RandomStream {
  public:
    RandomStream(uint32_t pixel, uint32_t sample, uint32_t seed,
                 Sampler sampler = Sampler::Independent);
    /// Uniform in [0, 1): a multiple of 2^-53.
    double next();
    /// Takes the next numbers from the beginning of a block: to be called before numbers that
    /// belong together, so that they are even together.
    void beginBlock();
    /// The first three numbers of the next block.
    glm::dvec3 threeNumbers();
    /// What the sample draws from here on in one of its branches: `count` times as many as there
    /// are samples, spread evenly together, in blocks that no unsplit path takes.
    RandomStream branch(uint32_t number, uint32_t count) const;

    /// Independent numbers of the same sample, from blocks that neither this stream nor a branch
    /// of it takes: for what is not always asked, so that no other number depends on it.
    RandomStream apart() const;

  private:
    void fill();

    uint32_t pixel_, sample_, seed_;
    Sampler sampler_;
    uint32_t block_ = 0;
    /// What the block's numbers are made of, which is done when they are asked for.
    std::array<uint32_t, 4> digits_{};
    std::array<uint64_t, 4> keys_{}; ///< independent numbers: the digits behind those
    unsigned used_ = 4;              ///< numbers that have been handed out
};

// --- Sobol points --------------------------------------------------------------------------------

/// The first four dimensions of Sobol's sequence.
inline constexpr size_t kSobolDimensions = 4;

/// Columns of a dimension's generator matrix: the coordinate of point i is the exclusive or of
/// those columns whose bit of i is set; digit k of the coordinate is bit 31 - k.
using SobolColumns = std::array<uint32_t, 32>;
const SobolColumns& sobolColumns(size_t dimension);

/// Coordinates of point `index` < 2^32, in units of 2^-32.
std::array<uint32_t, kSobolDimensions> sobolPoint(uint32_t index);

/// Owen's nested uniform scrambling (1995) of a 32-bit fraction, from its definition: each digit is
/// flipped or not by a bit of its own for each value of the digits before it, from hashes of them
/// and the key. In [0, 1), a multiple of 2^-53: what follows the 32 digits is the hash of all of
/// them.
double owenScrambled(uint32_t digits, uint64_t key);

/// Owen's permutation of the numbers below 2^24, by their digits as in owenScrambled(): 2^k of them
/// that begin at a multiple of 2^k stay such a set.
uint32_t owenShuffled(uint32_t index, uint64_t key);

// --- Warps ---------------------------------------------------------------------------------------

inline constexpr double kPi = 3.14159265358979323846;

/// Orthonormal frame with a given z axis; right-handed where that is all that is given.
struct Frame {
    glm::dvec3 x, y, z;

    /// z: unit.
    explicit Frame(const glm::dvec3& z);
    Frame(const glm::dvec3& xAxis, const glm::dvec3& yAxis, const glm::dvec3& zAxis)
        : x(xAxis), y(yAxis), z(zAxis) {}
    glm::dvec3 toWorld(const glm::dvec3& v) const { return v.x * x + v.y * y + v.z * z; }
    glm::dvec3 toLocal(const glm::dvec3& v) const {
        return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)};
    }
};

// u, v: independent, uniform in [0, 1). Directions are unit vectors, densities per solid angle.

/// Hemisphere z >= 0 with density z / pi (Malley's method).
glm::dvec3 cosineHemisphere(double u, double v);
/// Hemisphere z >= 0 with density 1 / (2 pi).
glm::dvec3 uniformHemisphere(double u, double v);
/// Whole sphere with density 1 / (4 pi).
glm::dvec3 uniformSphere(double u, double v);
/// Directions around z with 1 - cos <= oneMinusCosMax, density 1 / (2 pi oneMinusCosMax). In terms
/// of 1 - cos, which stays accurate for narrow cones.
glm::dvec3 uniformCone(double u, double v, double oneMinusCosMax);
/// Barycentric weights (b1, b2) of the second and third corner, uniform on the triangle's area.
glm::dvec2 uniformTriangle(double u, double v);

// --- Spherical triangles -------------------------------------------------------------------------

/// The directions in which a triangle is seen, sampled uniformly by solid angle: Arvo, "Stratified
/// Sampling of Spherical Triangles" (SIGGRAPH 1995).
class SphericalTriangle {
  public:
    /// Below this solid angle (steradians) the sum of angles from which it comes has lost too many
    /// digits: 16 roundings of 2^-53 of angles up to pi are 2^-20 of it.
    static constexpr double kSmallest = 0x1p-27;

    /// Unit directions of the corners.
    SphericalTriangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

    /// Steradians, in [0, 2 pi].
    double solidAngle() const { return area_; }
    /// Unit; u, v: independent, uniform in [0, 1). Density 1 / solidAngle(), which is at least
    /// kSmallest.
    glm::dvec3 sample(double u, double v) const;

  private:
    glm::dvec3 a_, b_, c_;
    double alpha_, area_; ///< alpha_: the angle at a
};

} // namespace stromboli::reference
