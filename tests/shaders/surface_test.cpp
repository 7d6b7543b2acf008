// surface.glsl on hits of real rays: the point, its error bound, the normals, and where rays that
// leave start: on the right side of the exact surface, at any scale.
#include "host/reference/surface.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/shaders/placed.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/surface_texel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

using gpu::SurfaceAnswer;
using gpu::SurfaceQuery;

class SurfaceTest : public DeviceTest {
  protected:
    void setScene(const Scene& scene) {
        const GpuScene packed = pack(scene);
        primitives_ = placed(packed);
        shader_.setScene(packed);
    }

    std::vector<SurfaceAnswer> answers(const std::vector<SurfaceQuery>& queries) {
        return ask<SurfaceAnswer>(shader_, queries);
    }

    std::vector<Placed> primitives_; ///< by scene primitive

    /// As a kernel without shading normals does it.
    std::vector<SurfaceAnswer> flatAnswers(const Scene& scene,
                                           const std::vector<SurfaceQuery>& queries) {
        TestShader shader(surface_texel, ShaderOptions::texel().set(SPEC_HAS_NORMALS, false));
        shader.setScene(pack(scene));
        return ask<SurfaceAnswer>(shader, queries);
    }

  private:
    TestShader shader_{surface_texel, ShaderOptions::texel()};
};

glm::dvec3 normalOf(const Placed& p) {
    const glm::dvec3 a(p.v0), b(p.v1), c(p.v2);
    return glm::normalize(glm::cross(b - a, c - a));
}

/// A ray from some way off at a point of the primitive, to leave it in any direction.
SurfaceQuery rayAt(const Placed& p, float size, Random& random) {
    SurfaceQuery q{};
    q.place = p.place;
    glm::vec3 target;
    if (p.isSphere) {
        target = p.v0 + 0.9f * p.radius * glm::normalize(random.vector());
    } else {
        const float b1 = random.uniform(), b2 = random.uniform() * (1 - b1);
        target = p.v0 + b1 * (p.v1 - p.v0) + b2 * (p.v2 - p.v0);
    }
    q.origin = target + size * random.vector();
    q.direction = glm::normalize(target - q.origin);
    q.leaving = glm::normalize(random.vector());
    return q;
}

TEST_F(SurfaceTest, RaysLeaveTrianglesOnTheRightSideAtAnyScale) {
    Random random(141);
    size_t hits = 0, naiveWrong = 0;
    for (int exponent = -8; exponent <= 8; exponent += 2)
        for (const float shift : {0.0f, 100.0f}) { // coordinates of the size, or far larger
            const float scale = std::pow(10.0f, float(exponent));
            // Triangles on their own, and pairs in a leaf.
            Scene scene = exponent % 4 == 0 ? soup(200, 0, 0.5f, random) : landscape(10);
            const glm::vec3 by = shift * random.inCube(1);
            for (glm::vec3& p : scene.positions)
                p = scale * (p + by);
            setScene(scene);
            std::vector<SurfaceQuery> queries;
            for (uint32_t i = 0; i < 5000; ++i)
                queries.push_back(rayAt(primitives_[i % 200], 2 * scale, random));
            const std::vector<SurfaceAnswer> found = answers(queries);
            for (size_t i = 0; i < queries.size(); ++i) {
                const SurfaceAnswer& a = found[i];
                if (!(a.t < kInfinite)) continue; // rounded past an edge
                ++hits;
                const Placed& p = primitives_[i % 200];
                const glm::dvec3 n = normalOf(p), corner(p.v0);
                ASSERT_GT(std::abs(glm::dot(n, glm::dvec3(a.geometric))), 0.9);
                const glm::dvec3 w(queries[i].leaving);
                const double side = glm::dot(n, w) > 0 ? 1 : -1;
                const double height = side * glm::dot(n, glm::dvec3(a.start) - corner);
                naiveWrong += side * glm::dot(n, glm::dvec3(a.position) - corner) < 0;
                if (std::abs(glm::dot(n, w)) < 1e-5) continue; // which side is for rounding to say
                ASSERT_GT(height, 0) << scale << ' ' << i << ": behind the surface";
                // Nor farther off than it need be: some roundings of the coordinates.
                const glm::dvec3 size = glm::abs(glm::dvec3(a.position));
                ASSERT_LT(height, 64 * 0x1p-24 * (size.x + size.y + size.z + 3 * scale));
                EXPECT_EQ(a.skipPrimitive, queries[i].place);
                EXPECT_FALSE(a.again < kInfinite) << scale << ' ' << i << ": hits itself";
            }
        }
    EXPECT_GT(hits, 60000u);
    EXPECT_GT(naiveWrong, hits / 10) << "negative control: without the offset";
}

/// The normals of flat triangles come with the scene: right to the last digit at any scale, and the
/// same bits with and without shading normals in the kernel.
TEST_F(SurfaceTest, FlatTrianglesHaveTheirNormalStored) {
    Random random(146);
    size_t hits = 0;
    for (const float scale : {1e-12f, 1.0f, 1e12f}) {
        Scene scene = soup(200, 0, 0.5f, random);
        for (glm::vec3& p : scene.positions)
            p = scale * (p + 1.0f);
        setScene(scene);
        std::vector<SurfaceQuery> queries;
        for (uint32_t i = 0; i < 5000; ++i)
            queries.push_back(rayAt(primitives_[i % 200], 2 * scale, random));
        const std::vector<SurfaceAnswer> found = answers(queries);
        const std::vector<SurfaceAnswer> flat = flatAnswers(scene, queries);
        for (size_t i = 0; i < queries.size(); ++i) {
            if (!(found[i].t < kInfinite)) continue;
            ++hits;
            const glm::dvec3 n = normalOf(primitives_[i % 200]);
            const double side = glm::dot(n, glm::dvec3(queries[i].direction)) < 0 ? 1 : -1;
            ASSERT_LE(glm::length(side * n - glm::dvec3(found[i].geometric)), 0x1p-24) << i;
            ASSERT_EQ(found[i].facing, found[i].geometric);
            ASSERT_EQ(flat[i].geometric, found[i].geometric);
            ASSERT_EQ(flat[i].start, found[i].start);
        }
    }
    EXPECT_GT(hits, 12000u);
}

TEST_F(SurfaceTest, TheErrorBoundHolds) {
    Random random(142);
    double most = 0;
    for (const float shift : {0.0f, 1.0f, 1000.0f}) {
        Scene scene = soup(200, 0, 0.5f, random);
        for (glm::vec3& p : scene.positions)
            p = p + shift;
        setScene(scene);
        std::vector<SurfaceQuery> queries;
        for (uint32_t i = 0; i < 20000; ++i)
            queries.push_back(rayAt(primitives_[i % 200], 2, random));
        const std::vector<SurfaceAnswer> found = answers(queries);
        for (size_t i = 0; i < queries.size(); ++i) {
            if (!(found[i].t < kInfinite)) continue;
            const Placed& p = primitives_[i % 200];
            const glm::dvec3 n = normalOf(p);
            const double off = std::abs(glm::dot(n, glm::dvec3(found[i].position - p.v0)));
            const double bound = glm::dot(glm::abs(n), glm::dvec3(found[i].error));
            ASSERT_LE(off, bound) << shift << ' ' << i;
            most = std::max(most, off / bound);
        }
    }
    EXPECT_GT(most, 0.05) << "the bound is loose by far";
}

/// Spheres are not skipped: only the offset keeps a ray from hitting the one it leaves.
TEST_F(SurfaceTest, RaysLeaveSpheresWithoutHittingThemAgain) {
    Random random(143);
    for (const float radius : {1e-6f, 0.1f, 1.0f, 1e6f})
        for (const float shift : {0.0f, 1.0f, 1e3f}) { // of the centre, in radii
            Scene scene;
            Sphere s;
            s.center = shift * radius * random.inCube(1);
            s.radius = radius;
            scene.spheres.push_back(s);
            setScene(scene);
            std::vector<SurfaceQuery> queries;
            for (uint32_t i = 0; i < 10000; ++i) {
                queries.push_back(rayAt(primitives_[0], 3 * radius, random));
                // Every other one starts inside.
                if (i % 2) queries.back().origin = s.center + 0.4f * radius * random.inCube(1);
            }
            const std::vector<SurfaceAnswer> found = answers(queries);
            int again = 0, missing = 0, wrongSide = 0;
            for (size_t i = 0; i < queries.size(); ++i) {
                ASSERT_LT(found[i].t, kInfinite) << radius << ' ' << i;
                const glm::dvec3 n =
                    glm::normalize(glm::dvec3(found[i].position) - glm::dvec3(s.center));
                const double cosine = glm::dot(n, glm::dvec3(queries[i].leaving));
                const double height =
                    glm::length(glm::dvec3(found[i].start) - glm::dvec3(s.center)) - double(radius);
                wrongSide += std::abs(cosine) > 1e-3 && (height > 0) != (cosine > 0);
                again += cosine > 1e-3 && found[i].again < kInfinite;
                // A ray into the sphere crosses it: 2 r cos.
                missing += cosine < -0.1 && std::abs(found[i].again / (-2 * cosine * radius) - 1) >
                                                0.01 + 1e-4 * shift;
            }
            EXPECT_EQ(wrongSide, 0) << radius << ' ' << shift;
            EXPECT_EQ(again, 0) << radius << ' ' << shift << ": hits itself";
            EXPECT_EQ(missing, 0) << radius << ' ' << shift << ": does not cross it";
        }
}

/// Gives two triangles in three shading normals; of some the normals cancel in the middle.
void addNormals(Scene& scene, Random& random) {
    for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
        if (i % 3 == 0) continue;
        Triangle& t = scene.triangles[i];
        const glm::vec3 n = scene.geometricNormal(t);
        const bool opposite = i % 30 == 1;
        for (uint32_t c = 0; c < 3; ++c) {
            t.normals[c] = uint32_t(scene.normals.size());
            const glm::vec3 tilted = glm::normalize(n + 0.7f * glm::normalize(random.vector()));
            scene.normals.push_back(opposite ? (c == 1 ? -n : n) : tilted);
        }
    }
}

/// What a triangle of the file has at a point: normals by barycentric weights, these by areas.
struct FileNormals {
    FileNormals(const Scene& scene, const Triangle& t, const glm::dvec3& x) {
        const glm::dvec3 v0(scene.positions[t.corner[0]]), v1(scene.positions[t.corner[1]]);
        const glm::dvec3 v2(scene.positions[t.corner[2]]);
        geometric = glm::normalize(glm::cross(v1 - v0, v2 - v0));
        interpolated = geometric;
        if (t.normals[0] == kNoNormals) return;
        const double area = glm::dot(geometric, glm::cross(v1 - v0, v2 - v0));
        const double b1 = glm::dot(geometric, glm::cross(x - v0, v2 - v0)) / area;
        const double b2 = glm::dot(geometric, glm::cross(v1 - v0, x - v0)) / area;
        interpolated = (1 - b1 - b2) * glm::dvec3(scene.normals[t.normals[0]]) +
                       b1 * glm::dvec3(scene.normals[t.normals[1]]) +
                       b2 * glm::dvec3(scene.normals[t.normals[2]]);
    }
    glm::dvec3 geometric, interpolated; ///< the latter not of unit length
};

/// Shading normals: interpolated, or the geometric one where there are none or they cancel; both
/// turned to the viewer. Leaves may hold triangles in pairs and begin with another of their
/// corners.
TEST_F(SurfaceTest, NormalsAreInterpolatedAndFaceTheViewer) {
    Random random(144);
    Scene mesh = landscape(12);
    for (Triangle& t : mesh.triangles)
        std::rotate(t.corner, t.corner + random.below(3), t.corner + 3);
    int hits = 0;
    for (Scene scene : {soup(300, 0, 1, random), mesh}) {
        addNormals(scene, random);
        setScene(scene);
        const size_t n = scene.triangles.size();
        std::vector<SurfaceQuery> queries;
        for (size_t i = 0; i < 30000; ++i)
            queries.push_back(rayAt(primitives_[i % n], 2, random));
        const std::vector<SurfaceAnswer> found = answers(queries);
        for (size_t i = 0; i < queries.size(); ++i) {
            const SurfaceAnswer& a = found[i];
            if (!(a.t < kInfinite)) continue;
            const FileNormals file(scene, scene.triangles[i % n], glm::dvec3(a.position));
            const glm::dvec3 wo = -glm::dvec3(queries[i].direction);
            if (std::abs(glm::dot(file.geometric, wo)) < 1e-3) continue;
            ++hits;
            EXPECT_EQ(a.outside != 0, glm::dot(file.geometric, wo) > 0) << i;
            EXPECT_GT(glm::dot(glm::dvec3(a.geometric), wo), 0) << i;
            EXPECT_NEAR(glm::length(a.shading), 1, 1e-6) << i;
            EXPECT_GE(glm::dot(a.facing, a.geometric), 0) << i;
            EXPECT_GT(glm::dot(glm::dvec3(a.facing), wo), 0) << i;
            const double length = glm::length(file.interpolated);
            if (length < 0.05) continue; // as good as cancelled
            // Octahedral normals are good to 4e-5; slivers have rough weights.
            const double tolerance = (1e-4 + 1e-4) / length;
            EXPECT_LT(glm::length(glm::dvec3(a.shading) - file.interpolated / length), tolerance)
                << i;
        }
    }
    EXPECT_GT(hits, 40000);
}

/// What the reference makes of a triangle of the file at the point that the kernel found.
struct FileSurface {
    FileSurface(const Scene& scene, const Triangle& t, const SurfaceAnswer& a) {
        for (int c = 0; c < 3; ++c) {
            smooth.corner[c] = scene.positions[t.corner[c]];
            smooth.normal[c] = scene.normals[t.normals[c]];
        }
        const glm::dvec3 g(a.geometric), x = glm::dvec3(a.position) - smooth.corner[0];
        const glm::dvec3 e1 = smooth.corner[1] - smooth.corner[0];
        const glm::dvec3 e2 = smooth.corner[2] - smooth.corner[0];
        const double area = glm::dot(g, glm::cross(e1, e2));
        const double b1 = glm::dot(g, glm::cross(x, e2)) / area;
        const double b2 = glm::dot(g, glm::cross(e1, x)) / area;
        size = glm::length(e1) + glm::length(e2);
        height = smooth.height({1 - b1 - b2, b1, b2}, g);
        for (const glm::dvec3& n : smooth.normal)
            leastTilt = std::min(leastTilt, std::abs(glm::dot(n, g)));
    }
    reference::SmoothTriangle smooth;
    double size, height, leastTilt = 1; ///< the last: sine of a normal's angle to the plane
};

/// The height of the smooth surface is the reference's, at any scale and whichever corner a leaf
/// begins with; and that is how far above the triangle light is reflected from.
TEST_F(SurfaceTest, LightLeavesFromTheSmoothSurface) {
    Random random(145);
    int lifted = 0;
    for (const float scale : {1e-8f, 1.0f, 1e8f}) {
        Scene scene = landscape(12);
        addNormals(scene, random);
        for (glm::vec3& p : scene.positions)
            p *= scale;
        setScene(scene);
        const size_t n = scene.triangles.size();
        std::vector<SurfaceQuery> queries;
        for (size_t i = 0; i < 10000; ++i)
            queries.push_back(rayAt(primitives_[i % n], 2 * scale, random));
        const std::vector<SurfaceAnswer> found = answers(queries);
        for (size_t i = 0; i < queries.size(); ++i) {
            const SurfaceAnswer& a = found[i];
            const Triangle& t = scene.triangles[i % n];
            if (!(a.t < kInfinite) || t.normals[0] == kNoNormals) continue;
            const FileSurface file(scene, t, a);
            // Octahedral normals are good to 4e-5; one in the plane may fall on either side.
            if (file.leastTilt < 1e-3) continue;
            EXPECT_NEAR(a.lift, file.height, 2e-4 * file.size) << scale << ' ' << i;
            const glm::dvec3 g(a.geometric);
            if (glm::dot(glm::dvec3(queries[i].leaving), g) < 1e-3) continue;
            lifted += file.height > 0.01 * file.size;
            const double start = glm::dot(g, glm::dvec3(a.start) - glm::dvec3(a.position));
            EXPECT_NEAR(start, file.height, 2e-4 * file.size) << scale << ' ' << i;
            EXPECT_GT(start, 0) << scale << ' ' << i;
        }
    }
    EXPECT_GT(lifted, 1000);
}

} // namespace
} // namespace stromboli::test
