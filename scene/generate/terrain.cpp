#include "scene/generate/terrain.hpp"

#include "scene/generate/noise.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {

namespace {

constexpr double kHalfWidth = 1450; // of the height field
constexpr double kDrowned = -12;    // cells lower than this are left out
constexpr double kCraterRadius = 115;
const glm::dvec2 kScar = glm::normalize(glm::dvec2(0.55, -0.83)); // where lava runs to the sea

/// 0 below `from`, 1 above `to`, smooth in between.
double step(double from, double to, double x) {
    return glm::smoothstep(from, to, x);
}

/// How much a point belongs to the bare slope below the crater, 0 to 1.
double scarAt(const glm::dvec2& p) {
    const double along = glm::dot(p, kScar), across = p.x * kScar.y - p.y * kScar.x;
    const double width = 60 + 0.28 * std::max(along, 0.0) + 25 * fractalNoise(p / 90.0, 3);
    return step(40, 160, along) * (1 - step(0.7 * width, 1.15 * width, std::fabs(across)));
}

/// Height of a cell decides what grows there, give or take.
std::string materialAt(const glm::dvec2& p) {
    const double height = volcanoHeight(p) + 90 * fractalNoise(p / 160.0, 4);
    if (scarAt(p) > 0.5) return "scar";
    if (volcanoHeight(p) < 9) return "beach";
    if (height > 560) return "ash";
    const double slope = (volcanoHeight(p + glm::dvec2(8, 0)) - volcanoHeight(p)) / 8;
    return height > 330 || std::fabs(slope) > 0.85 ? "rock" : "scrub";
}

/// Each normal is the mean of those of the triangles around it, weighted by their areas: the slope
/// between two cells can be too rough for the height field's own derivatives.
void addNormals(StripMesh& mesh) {
    mesh.normals.assign(mesh.positions.size(), glm::dvec3(0));
    for (const auto& [material, strips] : mesh.strips)
        for (const Strip& strip : strips)
            for (size_t i = 2; i < strip.size(); ++i) {
                const glm::dvec3 a = mesh.positions[strip[i - 2]];
                const glm::dvec3 face =
                    glm::cross(mesh.positions[strip[i - 1]] - a, mesh.positions[strip[i]] - a);
                for (size_t corner = i - 2; corner <= i; ++corner)
                    mesh.normals[strip[corner]] += i % 2 == 0 ? face : -face;
            }
    for (glm::dvec3& normal : mesh.normals)
        normal = glm::normalize(normal);
}

/// Points of the grid that are used, numbered in the order they are first asked for.
class GridPoints {
  public:
    GridPoints(uint32_t cells, StripMesh& mesh)
        : cells_(cells), numbers_(size_t(cells + 1) * (cells + 1), kUnused), mesh_(mesh) {}

    glm::dvec2 at(double column, double row) const {
        return kHalfWidth * (2.0 * glm::dvec2(column, row) / double(cells_) - 1.0);
    }

    uint32_t number(uint32_t column, uint32_t row) {
        uint32_t& number = numbers_[size_t(row) * (cells_ + 1) + column];
        if (number == kUnused) {
            number = uint32_t(mesh_.positions.size());
            const glm::dvec2 p = at(column, row);
            mesh_.positions.emplace_back(p, volcanoHeight(p));
        }
        return number;
    }

  private:
    static constexpr uint32_t kUnused = 0xFFFFFFFFu;
    uint32_t cells_;
    std::vector<uint32_t> numbers_;
    StripMesh& mesh_;
};

} // namespace

double volcanoHeight(const glm::dvec2& p) {
    const double radius = glm::length(p);
    const glm::dvec2 bent =
        p + 55.0 * glm::dvec2(fractalNoise(p / 300.0, 3), fractalNoise(p / 300.0 + 40.0, 3));
    const double shape = glm::length(bent * glm::dvec2(1.0, 1.14));
    double height = 1120 * std::exp(-shape / 590) - 150;
    // Gullies run down the flanks: ridges of noise that is stretched along the radius.
    const double angle = std::atan2(bent.y, bent.x);
    const glm::dvec2 flank = (3.2 + radius / 900) * glm::dvec2(std::cos(angle), std::sin(angle));
    const double steep = step(120, 420, radius) * (1 - step(900, 1500, radius));
    height += 100 * steep * (ridgedNoise(flank * 2.1, 4) - 0.55);
    height += 16 * fractalNoise(p / 70.0, 5) * step(60, 200, radius);
    // The scar is a smooth chute, the crater a bowl that is open towards it.
    height -= 70 * scarAt(p) * step(100, 400, radius) * (1 - step(700, 1300, radius));
    const glm::dvec2 vent = p - 35.0 * kScar;
    const double bowl = glm::length(vent) / kCraterRadius + 0.12 * fractalNoise(p / 45.0, 3);
    return height - 330 * std::exp(-bowl * bowl * bowl);
}

StripMesh volcanoIsland(uint32_t cells) {
    StripMesh mesh;
    GridPoints points(cells, mesh);
    for (uint32_t row = 0; row < cells; ++row) {
        std::string current; // material of the strip being made; empty at sea
        for (uint32_t column = 0; column < cells; ++column) {
            const glm::dvec2 middle = points.at(column + 0.5, row + 0.5);
            const std::string material =
                volcanoHeight(middle) < kDrowned ? std::string() : materialAt(middle);
            if (!material.empty() && material == current) {
                Strip& strip = mesh.strips[material].back();
                strip.push_back(points.number(column + 1, row + 1));
                strip.push_back(points.number(column + 1, row));
            } else if (!material.empty()) {
                mesh.strips[material].push_back(
                    {points.number(column, row + 1), points.number(column, row),
                     points.number(column + 1, row + 1), points.number(column + 1, row)});
            }
            current = material;
        }
    }
    addNormals(mesh);
    return mesh;
}

} // namespace stromboli
