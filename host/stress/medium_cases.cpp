#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace stromboli::stress {

// --- Media ---------------------------------------------------------------------------------------

namespace {

constexpr double kPermittedSigmas = 4.5;

/// Looks at a place along a line of its own, with all rays alike.
Camera along(const glm::dvec3& from, const glm::dvec3& to) {
    Camera camera = lookingAt(from, to, 1e-9);
    camera.orthographic = true;
    return camera;
}

/// What a finding keeps of the worst of its parts: the share of what is allowed.
void note(Finding& f, const Totals& found, const glm::dvec3& expected, double freely,
          const std::string& where) {
    for (int c = 0; c < 3; ++c) {
        const double allowed = freely * expected[c] + kPermittedSigmas * found.error()[c];
        const double share = std::abs(found.all.mean[c] - expected[c]) / allowed;
        if (!(share <= f.measured)) f.measured = share, f.where = where;
    }
    f.trials += found.all.taken();
}

/// A medium that absorbs as much as it scatters, and sends out what a body of radiance 1 would: in
/// a room of radiance 1 that is what is seen everywhere, whatever the density and wherever the
/// medium ends. By densities of a ball and of a grid in it whose cells are as far apart as the
/// densities.
Finding densities(Run& run) {
    Finding f;
    f.bound = 1;
    const std::vector<double> all = run.quick() ? std::vector<double>{1e-6, 1, 1e6}
                                                : std::vector<double>{1e-6, 1e-3, 1, 1e3, 1e6};
    for (const double density : all)
        for (const bool varies : {false, true}) {
            // Where nothing is, a grid takes as many steps as its densest place nearby.
            if (varies && (density > 1e3 || (run.quick() && density != 1))) continue;
            const glm::vec3 half = float(density / 2) * glm::vec3(1, 0.5f, 0.25f);
            Medium m = mediumOf(half, half);
            m.emission = half;
            if (varies) {
                DensityGrid& grid = m.density.emplace();
                grid.size = {5, 3, 4};
                for (int i = 0; i < 60; ++i)
                    grid.values.push_back(i % 3 == 0 ? 0 : i % 3 == 1 ? 1e-6f : 1.0f);
                grid.setWorld(
                    glm::dmat4({2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {-1, -1, -1, 1}));
            }
            SceneMaker b;
            b.box({-2, -2, -2}, {2, 2, 2}, b.add(emissive(1)), true);
            b.sphere({0, 0, 0}, 1, b.add(border(b.add(m))));
            const Totals found(run.render(b.scene, lookingAt({0.3, 1.8, 0.2}, {0, 0, 0}, 0.6),
                                          picture(8, run.amount(64u, 2048u), 60))
                                   .film);
            note(f, found, glm::dvec3(1), kRounding,
                 fmt::format("density {}{}", density, varies ? " in a grid" : ""));
        }
    return f;
}

/// Rays that absorb by known ways: past the middles of balls in each other, almost along their
/// surfaces, through the common face of two boxes and almost along it, and from cameras that stand
/// on a border. No randomness.
Finding borders(Run& run) {
    Finding f;
    f.bound = 1;
    const glm::dvec3 outer(0.25, 0.5, 1), inner(2, 1, 0.5);
    SceneMaker b;
    b.box({-8, -8, -8}, {8, 8, 8}, b.add(emissive(1)), true);
    const uint32_t a = b.add(mediumOf(outer)), i = b.add(mediumOf(inner));
    b.sphere({0, 0, 0}, 1, b.add(border(a)));
    b.sphere({0, 0, 0}, 0.5f, b.add(border(i, a)));
    // Boxes of half a metre on both sides of y = 4, whose common face is one surface.
    const uint32_t toOuter = b.add(border(a)), toInner = b.add(border(i));
    const auto openBox = [&](float side, uint32_t material) {
        // A box without the face y = 4, its normals outwards; side: 1 above, -1 below.
        const float y = 4 + 0.5f * side;
        b.quad({-0.5f, y, -0.5f}, side > 0 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0),
               side > 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1), material);
        const float low = std::min(y, 4.0f);
        b.quad({-0.5f, low, -0.5f}, {0, 0, 1}, {0, 0.5f, 0}, material);
        b.quad({0.5f, low, -0.5f}, {0, 0.5f, 0}, {0, 0, 1}, material);
        b.quad({-0.5f, low, -0.5f}, {0, 0.5f, 0}, {1, 0, 0}, material);
        b.quad({-0.5f, low, 0.5f}, {1, 0, 0}, {0, 0.5f, 0}, material);
    };
    openBox(1, toInner);
    openBox(-1, toOuter);
    b.quad({-0.5f, 4, -0.5f}, {0, 0, 1}, {1, 0, 0}, b.add(border(a, i)));
    const auto check = [&](const Camera& camera, const glm::dvec3& depth, double error,
                           const std::string& where) {
        note(f, Totals(run.render(b.scene, camera, picture(1, 1, 1)).film), glm::exp(-depth),
             kRounding + error, where);
    };
    // What is known of a chord is the square of its half, to some roundings of the radius.
    for (const double distance : {0.0, 0.3, 0.499, 0.5 - 1e-6, 0.6, 0.999, 1 - 1e-6}) {
        const double half = std::sqrt(1 - distance * distance);
        const double within = distance < 0.5 ? std::sqrt(0.25 - distance * distance) : 0;
        const double error = 1e-6 / half + (within > 0 ? 1e-6 / within : 0);
        check(along({distance, 0, 4}, {distance, 0, 0}),
              2 * (half - within) * outer + 2 * within * inner, error,
              fmt::format("chord {} from the middle", distance));
    }
    check(along({0.1, 6, 0.2}, {0.1, 0, 0.2}),
          0.5 * (outer + inner) + 2 * (std::sqrt(0.95) - std::sqrt(0.2)) * outer +
              2 * std::sqrt(0.2) * inner,
          1e-5, "through both boxes");
    for (const double height : {1e-4, -1e-4, 1e-6, -1e-6})
        check(along({-3, 4 + height, 0.1}, {0, 4 + height, 0.1}), height > 0 ? inner : outer, 1e-5,
              fmt::format("along the common face, {} from it", height));
    const double slope = 1e-3; // from 0.25 mm above the common face to as much below it
    check(along({-0.75, 4 + 0.75 * slope, 0.1}, {0, 4, 0.1}),
          0.5 * std::sqrt(1 + slope * slope) * (outer + inner), 1e-3,
          "almost along the common face");
    // Close to the upper face of the boxes, on either side of it, looking in.
    for (const double height : {1e-5, -1e-5}) {
        Camera camera = along({0, 4.5 + height, 0}, {0, 4, 0});
        camera.medium = mediumAt(b.scene, camera.position);
        check(camera, 1.5 * (outer + inner), 1e-4,
              fmt::format("a camera {} above a border", height));
    }
    return f;
}

/// Layers of two media on a mirror, each with faces of its own, in a room of radiance 1: what two
/// ways through both leave, at several sizes, upright and turned. Faces in one plane are cut into
/// triangles at other places. No randomness but in what rounding does.
Finding interfaces(Run& run) {
    Finding f;
    f.bound = 1;
    const glm::dvec3 below(0.25, 0.5, 1), above(2, 1, 0.5);
    // As Scene turned() turns.
    const glm::dmat3 turn(glm::dvec3(2, 3, 6) / 7.0, glm::dvec3(3, -6, 2) / 7.0,
                          glm::dvec3(6, 2, -3) / 7.0);
    for (const float size : sizes(run))
        for (const bool isTurned : {false, true}) {
            SceneMaker b;
            b.box({-9, -9, -9}, {9, 9, 9}, b.add(emissive(1)), true);
            b.quad({-5, 0.3f, -4}, {0, 0, 9}, {10, 0, 0}, b.add(mirror(1)));
            const float perMetre = 1 / size;
            b.box({-3, 0.3f, -3}, {3.2f, 0.9f, 2.8f},
                  b.add(border(b.add(mediumOf(perMetre * glm::vec3(below))))));
            b.box({-2.9f, 0.9f, -3.3f}, {3.4f, 1.3f, 2.7f},
                  b.add(border(b.add(mediumOf(perMetre * glm::vec3(above))))));
            const Scene scene = placed(isTurned ? turned(b.scene) : b.scene, size);
            for (uint32_t i = 0; i < run.amount(4u, 32u); ++i) {
                // Spread evenly over the layers, by the golden ratio and the root of 2.
                const glm::dvec3 at(std::fmod(0.618034 * i, 1) - 0.5, 0.3,
                                    std::fmod(0.414214 * i, 1) - 0.5);
                const glm::dvec3 way(0.3 * std::cos(double(i)), 1, 0.3 * std::sin(double(i)));
                const auto world = [&](const glm::dvec3& p) {
                    return double(size) * (isTurned ? turn * p : p);
                };
                const glm::dvec3 depth = 2 * glm::length(way) * (0.6 * below + 0.4 * above);
                note(f,
                     Totals(run.render(scene, along(world(at + 2.0 * way), world(at)),
                                       picture(1, 1, 2))
                                .film),
                     glm::exp(-depth), kRounding, fmt::format("size {}, ray {}", size, i));
            }
        }
    return f;
}

/// Grids without anything, of a single cell, of many, with steps of 1e6 between cells: what is left
/// is the exponential of their mean along the way.
Finding grids(Run& run) {
    Finding f;
    f.bound = 1;
    const uint32_t many = run.amount(100'000u, 4'000'000u);
    struct Kind {
        const char* name;
        uint32_t cells;
        float odd, even;
    };
    for (const Kind& kind : {Kind{"empty", 64, 0, 0}, Kind{"one cell", 1, 1, 1},
                             Kind{"many cells", many, 0, 2}, Kind{"steps", 50, 1e-6f, 2}}) {
        Medium m = mediumOf({0.5f, 1, 0.25f});
        DensityGrid& grid = m.density.emplace();
        grid.size = {kind.cells > 1 ? 2u : 1u, kind.cells > 1 ? kind.cells / 2 : 1, 1};
        if (grid.size.y > 1000) grid.size = {2, 1000, grid.size.y / 1000};
        const size_t count = size_t(grid.size.x) * grid.size.y * grid.size.z;
        for (size_t i = 0; i < count; ++i)
            grid.values.push_back(i / grid.size.x % 2 == 0 ? kind.even : kind.odd);
        grid.setWorld(glm::dmat4({2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {-1, -1, -1, 1}));
        SceneMaker b;
        b.box({-8, -8, -8}, {8, 8, 8}, b.add(emissive(1)), true);
        b.box({-1, -1, -1}, {1, 1, 1}, b.add(border(b.add(m))));
        const Totals found(run.render(b.scene, along({0.1, 4, 0.2}, {0.1, 0, 0.2}),
                                      picture(16, run.amount(16u, 256u), 1))
                               .film);
        // The linear functions between cells have the mean of the cells, up to whose outer faces
        // the density is theirs.
        const double odd = std::floor(double(grid.size.y) / 2) / grid.size.y;
        const double mean = odd * double(kind.odd) + (1 - odd) * double(kind.even);
        note(f, found, glm::exp(-2 * mean * glm::dvec3(m.extinction())), kRounding, kind.name);
    }
    return f;
}

/// White media in a ball of glass in a ball of glass, in light 1 from everywhere.
Finding mediaInGlass(Run& run) {
    Finding f;
    f.bound = 1;
    SceneMaker b;
    Medium milk = mediumOf(glm::vec3(0), {2, 1, 0.5f}),
           fog = mediumOf(glm::vec3(0), glm::vec3(0.5f));
    milk.asymmetry = 0.7f;
    const uint32_t inner = b.add(milk), outer = b.add(fog);
    Material shell = glass(1.5f);
    shell.boundsMedia = true;
    shell.inside = outer;
    b.sphere({0, 0, 0}, 1, b.add(shell));
    shell.ior = 1.2f;
    shell.inside = inner, shell.outside = outer;
    b.sphere({0, 0.1f, 0}, 0.5f, b.add(shell));
    b.add(ambient(1));
    note(f,
         Totals(run.render(b.scene, lookingAt({0, 0, 4}, {0, 0, 0}, 0.15),
                           picture(16, run.amount(16u, 512u), 20'000))
                    .film),
         glm::dvec3(1), kRounding, "");
    return f;
}

} // namespace

std::vector<Case> mediumCases() {
    return {
        {"media-densities", "79", "media of densities from 1e-6 to 1e6 that glow are furnaces",
         "share of limit", "samples", densities},
        {"media-borders", "80", "grazing rays, common faces, cameras at borders: known ways",
         "share of limit", "rays", borders},
        {"media-interfaces", "83", "layers of media on a mirror, faces in one plane: known ways",
         "share of limit", "rays", interfaces},
        {"media-grids", "81", "empty and huge grids let through what their mean does",
         "share of limit", "samples", grids},
        {"media-in-glass", "82", "white media in glass in glass keep the light", "share of limit",
         "samples", mediaInGlass},
    };
}

} // namespace stromboli::stress
