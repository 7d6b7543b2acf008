#include "scene/generate/gnarled_knot.hpp"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

namespace stromboli {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRingRadius = 0.66, kCoilRadius = 0.30, kTubeRadius = 0.17;
constexpr int kAroundAxis = 2, kAroundRing = 3; // a trefoil

/// Where the knot's middle line runs on its torus, whose axis is y.
struct Frame {
    glm::dvec3 middle, out; ///< out: the torus's normal, at right angles to the line
};

Frame frameAt(double u) {
    const double ring = kAroundAxis * u, coil = kAroundRing * u;
    const glm::dvec3 radial(std::cos(ring), 0, std::sin(ring));
    const glm::dvec3 out = std::cos(coil) * radial + glm::dvec3(0, std::sin(coil), 0);
    return {kRingRadius * radial + kCoilRadius * out, out};
}

/// The tube's radius. Frequencies are whole numbers, so that the surface closes.
double radiusAt(double u, double v) {
    const double ridges = std::sin(9 * v + 14 * u + 0.8 * std::sin(5 * u));
    const double bark = std::sin(17 * v - 31 * u) * std::sin(43 * u + 4 * v);
    const double burls = std::pow(0.5 + 0.5 * std::sin(6 * u + 1.3) * std::cos(2 * v - 5 * u), 6);
    const double swelling = std::sin(4 * u + 0.5);
    return kTubeRadius * (1 + 0.10 * ridges + 0.035 * bark + 0.38 * burls + 0.10 * swelling);
}

/// u runs along the knot, v around the tube, both once from 0 to 2 pi.
glm::dvec3 surfaceAt(double u, double v) {
    constexpr double kStep = 1e-5; // of a central difference: errors near 1e-10
    const Frame frame = frameAt(u);
    const glm::dvec3 along = glm::normalize(frameAt(u + kStep).middle - frameAt(u - kStep).middle);
    const glm::dvec3 side = glm::cross(along, frame.out);
    return frame.middle + radiusAt(u, v) * (std::cos(v) * frame.out + std::sin(v) * side);
}

glm::dvec3 normalAt(double u, double v) {
    constexpr double kStep = 1e-4; // leaves errors far below the digits written
    const glm::dvec3 alongU = surfaceAt(u + kStep, v) - surfaceAt(u - kStep, v);
    const glm::dvec3 alongV = surfaceAt(u, v + kStep) - surfaceAt(u, v - kStep);
    return glm::normalize(glm::cross(alongV, alongU));
}

} // namespace

StripMesh gnarledKnot(uint32_t along, uint32_t around, const std::string& material) {
    StripMesh mesh;
    mesh.positions.resize(size_t(along) * around);
    mesh.normals.resize(mesh.positions.size());
    tbb::parallel_for(0u, along, [&](uint32_t i) {
        for (uint32_t j = 0; j < around; ++j) {
            const double u = kTurn * i / along, v = kTurn * j / around;
            mesh.positions[size_t(i) * around + j] = surfaceAt(u, v);
            mesh.normals[size_t(i) * around + j] = normalAt(u, v);
        }
    });
    for (uint32_t i = 0; i < along; ++i) {
        Strip strip;
        for (uint32_t j = 0; j <= around; ++j) {
            strip.push_back((i + 1) % along * around + j % around);
            strip.push_back(i * around + j % around);
        }
        mesh.strips[material].push_back(strip);
    }
    return mesh;
}

} // namespace stromboli
