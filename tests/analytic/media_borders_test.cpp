// Borders of media that lie in the planes of surfaces and of other borders, where rounding says
// which of them a ray meets first (docs/theory/media.md, "Borders in the planes of surfaces").
#include "tests/analytic/media.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <random>

namespace stromboli {
namespace {

using namespace test;

/// A frame in which boxes are built. Corners are rounded in the world, so that coordinates that are
/// equal in a turned frame are planes that differ by rounding there.
struct Place {
    glm::dmat3 turn{1.0};
    glm::dvec3 at{0.0};

    glm::dvec3 operator()(const glm::dvec3& p) const { return turn * p + at; }
};

const Place kPlaces[] = {
    {},
    {glm::dmat3(1.0), {0.1, 0.7, 0.3}},
    {glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.48, 0.6, 0.64))), {3.1, -2, 7.3}}};

/// A box whose normals point outwards.
void addBox(SceneMaker& b, const Place& place, const glm::dvec3& lo, const glm::dvec3& hi,
            uint32_t material) {
    for (const int axis : {0, 1, 2})
        for (const bool isUpper : {false, true}) {
            glm::dvec3 corner = lo, e1(0), e2(0);
            e1[(axis + 1) % 3] = hi[(axis + 1) % 3] - lo[(axis + 1) % 3];
            e2[(axis + 2) % 3] = hi[(axis + 2) % 3] - lo[(axis + 2) % 3];
            if (isUpper)
                corner[axis] = hi[axis];
            else
                std::swap(e1, e2);
            b.quad(place(corner), place.turn * e1, place.turn * e2, material);
        }
}

/// Fog stands on a floor, which is lit by a point light above the fog: light comes down through the
/// fog and goes up through it. No randomness but in what rounding does.
TEST(MediaBorders, FogStandsOnAFloor) {
    const glm::dvec3 extinction(0.5, 1, 0.25);
    std::mt19937 random(1);
    const auto between = [&](double a, double b) {
        return a + (b - a) * double(random()) / 0x1p32;
    };
    for (const Place& place : kPlaces) {
        SceneMaker b;
        b.quad(place({-9, -9, 0.3}), place.turn * glm::dvec3(19, 0, 0),
               place.turn * glm::dvec3(0, 18, 0), b.add(diffuse(0.5f)));
        addBox(b, place, {-2.3, -2.1, 0.3}, {2.2, 2.4, 1.3},
               b.add(border(b.add(mediumOf(extinction)))));
        // A denser one in it, on the same floor.
        const glm::dvec3 more(2, 0.5, 1);
        addBox(b, place, {-1.1, -1.3, 0.3}, {1.2, 1.4, 0.8},
               b.add(border(b.add(mediumOf(more)), 0)));
        Light l;
        l.position = place({0.05, 0.1, 5.3});
        l.constantAttenuation = 0;
        l.quadraticAttenuation = 1;
        b.add(l);
        for (int i = 0; i < 24; ++i) {
            const bool isInner = i % 2 == 0;
            const double x = isInner ? between(-0.7, 0.7) : between(1.7, 1.9);
            const glm::dvec3 at(x, between(-0.8, 0.8), 0.3);
            const glm::dvec3 eye = at + glm::dvec3(between(-0.4, 0.4), between(-0.4, 0.4), 3);
            // The ways through the layers of both, which rays leave by their upper faces.
            const glm::dvec3 toLight = glm::dvec3(0.05, 0.1, 5.3) - at, toEye = eye - at;
            const double slope = glm::length(toLight) / toLight.z + glm::length(toEye) / toEye.z;
            const glm::dvec3 depth = slope * (isInner ? 0.5 * more + 0.5 * extinction : extinction);
            const double arrives =
                0.5 / kPi * toLight.z / glm::length(toLight) / glm::dot(toLight, toLight);
            const Estimate found =
                estimate(b.scene, pointCamera(place(eye), place(at)), smallPicture(1, 1));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found.mean[c] / (arrives * exponential(depth)[c]), 1, 1e-3)
                    << i << ' ' << c;
        }
    }
}

/// What is seen through boxes of media that touch.
glm::dvec3 seenThrough(const Scene& scene, const glm::dvec3& from, const glm::dvec3& to) {
    return estimate(scene, pointCamera(from, to), smallPicture(1, 1)).mean;
}

/// Boxes with faces in one plane: side by side, of different and of equal media, one in the other
/// with a common face, and the same face twice. Rays from both sides, by known ways.
TEST(MediaBorders, BoxesTouchAndShareFaces) {
    const glm::dvec3 one(0.5, 1, 0.25), two(2, 0.25, 0.75);
    std::mt19937 random(2);
    const auto between = [&](double a, double b) {
        return a + (b - a) * double(random()) / 0x1p32;
    };
    for (const Place& place : kPlaces)
        for (const int kind : {0, 1, 2, 3}) {
            SceneMaker b;
            addBox(b, place, {-20, -20, -20}, {20, 20, 20}, b.add(emissive(1)));
            const uint32_t outer = b.add(mediumOf(one));
            const uint32_t inner = kind == 1 ? outer : b.add(mediumOf(two));
            glm::dvec3 depth = one;
            addBox(b, place, {-2, -1.7, -0.7}, {2.3, 2.1, 0.3}, b.add(border(outer)));
            if (kind < 2) { // above it
                addBox(b, place, {-1.9, -2, 0.3}, {2.2, 2.4, 0.8}, b.add(border(inner)));
                depth += 0.5 * (kind == 1 ? one : two);
            } else if (kind == 2) { // in it, up to its upper face
                addBox(b, place, {-1.9, -1.6, -0.2}, {2.2, 2, 0.3}, b.add(border(inner, outer)));
                depth = 0.5 * (one + two);
            } else { // its upper face again
                b.quad(place({-1.9, -1.6, 0.3}), place.turn * glm::dvec3(4.1, 0, 0),
                       place.turn * glm::dvec3(0, 3.6, 0), b.add(border(outer)));
            }
            for (int i = 0; i < 24; ++i) {
                const glm::dvec3 at(between(-1, 1), between(-1, 1), 0.3);
                glm::dvec3 way(between(-1, 1), between(-1, 1), 2);
                const double slope = glm::length(way) / way.z;
                if (i % 2) way = -way;
                const glm::dvec3 seen = seenThrough(b.scene, place(at - way), place(at));
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(seen[c] / exponential(slope * depth)[c], 1, 1e-4)
                        << kind << ' ' << i << ' ' << c;
            }
        }
}

/// A pane of clear glass in the wall of a box of fog, seen from both sides.
TEST(MediaBorders, PanesLieInThePlaneOfABorder) {
    const glm::dvec3 extinction(0.5, 1, 0.25);
    std::mt19937 random(3);
    const auto between = [&](double a, double b) {
        return a + (b - a) * double(random()) / 0x1p32;
    };
    Material pane;
    pane.kind = MaterialKind::ThinDielectric;
    pane.ior = 1;
    for (const Place& place : kPlaces) {
        SceneMaker b;
        addBox(b, place, {-20, -20, -20}, {20, 20, 20}, b.add(emissive(1)));
        addBox(b, place, {-2, -1.7, -0.7}, {2.3, 2.1, 0.3},
               b.add(border(b.add(mediumOf(extinction)))));
        b.quad(place({-1.9, -1.6, 0.3}), place.turn * glm::dvec3(4.1, 0, 0),
               place.turn * glm::dvec3(0, 3.6, 0), b.add(pane));
        for (int i = 0; i < 24; ++i) {
            const glm::dvec3 at(between(-1, 1), between(-1, 1), 0.3);
            glm::dvec3 way(between(-1, 1), between(-1, 1), 2);
            const double slope = glm::length(way) / way.z;
            if (i % 2) way = -way;
            RenderSettings s = smallPicture(1, 2);
            const glm::dvec3 seen =
                estimate(b.scene, pointCamera(place(at - way), place(at)), s).mean;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(seen[c] / exponential(slope * extinction)[c], 1, 1e-4) << i << ' ' << c;
        }
    }
}

} // namespace
} // namespace stromboli
