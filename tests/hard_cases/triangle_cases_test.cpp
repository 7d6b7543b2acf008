// Hard cases 8, 9, 10 and 13: triangles that are seen edge-on, or all but.
#include "tests/bvh/oracle.hpp"
#include "tests/hard_cases/hits.hpp"
#include "tests/hard_cases/naive_intersection.hpp"
#include "tests/scene/collada/document_text.hpp"

#include <fmt/format.h>

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

/// A file of these triangles and one that is far away from all rays, for a file of nothing is an
/// error.
Scene loadTriangles(const std::vector<glm::vec3>& corners) {
    std::string numbers = "1e6 0 0 1e6 1 0 1e6 0 1", indices = "0 1 2";
    for (size_t i = 0; i < corners.size(); ++i) {
        numbers += fmt::format(" {} {} {}", corners[i].x, corners[i].y, corners[i].z);
        indices += fmt::format(" {}", i + 3);
    }
    DocumentText document;
    document.libraries = meshLibrary(numbers, 3 * int(corners.size() + 3),
                                     fmt::format("<triangles count=\"{}\">{}<p>{}</p></triangles>",
                                                 corners.size() / 3 + 1, kVertexInput, indices));
    document.nodes = meshNode();
    return load(document);
}

/// pbrt 4, Triangle.BadCases: corners on a line, which is no triangle, but the ray all but meets
/// it. Lines do not get as far as the ray's test: sheared and rounded, their corners are on a line
/// no more.
TEST_F(HardCases, C08_TriangleOfPbrtThatIsALine) {
    std::vector<glm::vec3> corners = {{-1113.45459f, -79.049614f, -56.2431908f},
                                      {-1113.45459f, -87.0922699f, -56.2431908f},
                                      {-1113.45459f, -79.2090149f, -56.2431908f}};
    std::vector<stress::Ray> rays = {{{-1081.47925f, 99.9999542f, 87.7701111f},
                                      0.9999f,
                                      {-32.1072998f, -183.355865f, -144.607635f},
                                      0}};
    Random random(1108); // lines like it, and rays as near
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 at = 1000.0f * random.inCube(1), from = at + 200.0f * random.inCube(1);
        for (int k = 0; k < 3; ++k) {
            corners.push_back(at);
            corners.back()[i % 3] += random.uniform(-10, 10);
        }
        const glm::vec3* line = &corners.back() - 2;
        const glm::vec3 to = line[0] + random.uniform() * (line[1] - line[0]) - from;
        rays.push_back({from, naive::kMissed, to, 0});
    }
    const Scene scene = loadTriangles(corners);
    EXPECT_EQ(scene.triangles.size(), 1u);
    const HitCounts hits = countHits(scene, rays);
    EXPECT_EQ(hits.cpu, 0u);
    EXPECT_EQ(hits.device, 0u);
    uint32_t kept = 0;
    for (size_t i = 0; i < rays.size(); ++i)
        kept += bool(hitTriangle(corners[3 * i], corners[3 * i + 1], corners[3 * i + 2],
                                 PreparedRay(rays[i].origin, rays[i].direction)));
    EXPECT_GT(kept, 0u) << "negative control: lines that were not dropped";
}

/// Where the line of a ray is nearest to the corners' extent, in lengths of the direction.
struct Extent {
    double least = INFINITY, most = -INFINITY;
    Extent(const glm::vec3* corners, const stress::Ray& ray) {
        const glm::dvec3 d(ray.direction), o(ray.origin);
        for (int i = 0; i < 3; ++i) {
            const double t = glm::dot(glm::dvec3(corners[i]) - o, d) / glm::dot(d, d);
            least = std::min(least, t), most = std::max(most, t);
        }
    }
};

/// Inside if the edge functions are not negative beyond their rounding; t from the plane alone.
float hitLoosely(const glm::vec3* corner, const stress::Ray& ray) {
    const glm::vec3 a = corner[0] - ray.origin, b = corner[1] - ray.origin,
                    c = corner[2] - ray.origin;
    const float u = glm::dot(glm::cross(c - b, c + b), ray.direction);
    const float v = glm::dot(glm::cross(a - c, a + c), ray.direction);
    const float w = glm::dot(glm::cross(b - a, b + a), ray.direction);
    const float slack = 0x1p-23f * std::abs(u + v + w);
    const bool inside = std::min({u, v, w}) >= -slack || std::max({u, v, w}) <= slack;
    const glm::vec3 n = glm::cross(b - a, c - a);
    const float t = glm::dot(n, a) / glm::dot(n, ray.direction);
    return inside && t > 0 ? t : naive::kMissed;
}

/// Rays at 0.5 degrees and less to triangles a thousand times as long as wide, beside them and
/// through them: where there is a hit it is on the triangle, to within what rounding of coordinates
/// up to 200 does along so flat a ray.
TEST_F(HardCases, C09_GrazingRaysAtSkinnyTriangles) {
    Random random(1109);
    uint32_t hits = 0, madeUp = 0;
    stress::DeviceSubject device(testDevice());
    for (int i = 0; i < 40; ++i) {
        const glm::vec3 along = 100.0f * glm::normalize(random.vector());
        const glm::vec3 across = glm::normalize(glm::cross(along, random.vector()));
        const glm::vec3 normal = glm::normalize(glm::cross(along, across));
        const glm::vec3 a = random.inCube(1);
        const glm::vec3 corner[] = {a, a + along, a + along + 0.1f * across};
        std::vector<stress::Ray> rays;
        for (int k = 0; k < 1000; ++k) {
            const float slope = 0.0087f * random.uniform(); // of 0.5 degrees
            const glm::vec3 d =
                glm::normalize(along / 100.0f - slope * normal + 0.001f * random.inCube(1));
            const glm::vec3 target =
                a + random.uniform() * along + 0.2f * random.uniform() * across;
            rays.push_back({target - 10.0f * d, naive::kMissed, d, 0});
        }
        const Scene scene = sceneOf(corner[0], corner[1], corner[2]);
        const WideLayout layout = buildWideBvh(scene);
        const std::vector<float> onDevice = device.tracer(scene)->distances(rays);
        for (size_t k = 0; k < rays.size(); ++k) {
            TraversalRay ray;
            ray.origin = rays[k].origin, ray.direction = rays[k].direction;
            const TraversalHit hit = closestHit(layout, ray);
            const Extent extent(corner, rays[k]);
            for (const float t : {hit ? hit.t : naive::kMissed, onDevice[k]}) {
                if (t == naive::kMissed) continue;
                ++hits;
                ASSERT_GT(t, extent.least - 0.5) << i << ' ' << k;
                ASSERT_LT(t, extent.most + 0.5) << i << ' ' << k;
            }
            const float loose = hitLoosely(corner, rays[k]);
            madeUp +=
                loose < naive::kMissed && (loose < extent.least - 0.5 || loose > extent.most + 0.5);
        }
    }
    EXPECT_GT(hits, 1000u);
    EXPECT_GT(madeUp, 0u) << "negative control: t from the plane of a triangle seen edge-on";
}

/// Rays within the plane of a triangle miss it; directions with zeros, of either sign, find what
/// the same directions without zeros find.
TEST_F(HardCases, C10_RaysInThePlaneAndZeroDirections) {
    Random random(1110);
    std::vector<stress::Ray> inPlane, zeros, nearly;
    Scene flat = soup(50, 0, 0.5f, random), mesh = cubeMesh(4);
    for (glm::vec3& p : flat.positions)
        p.y = 0.25f;
    flat.materials.resize(1);
    mesh.materials.resize(1);
    uint32_t lost = 0;
    for (int i = 0; i < 3000; ++i) {
        glm::vec3 o = random.inCube(2), d = random.vector();
        o.y = 0.25f, d.y = i % 2 ? 0.0f : -0.0f;
        inPlane.push_back({o, naive::kMissed, d, 0});
        // From inside the cube, on the planes where boxes of its triangles end.
        glm::vec3 inside = glm::round(4.0f * random.inCube(0.7f)) / 4.0f, straight(0.0f);
        for (int k = 0; k < 3; ++k)
            if (k != i % 3) straight[k] = random.below(2) ? 0.0f : -0.0f;
        straight[i % 3] = random.below(2) ? 1.0f : -1.0f;
        zeros.push_back({inside, naive::kMissed, straight, 0});
        nearly.push_back({inside, naive::kMissed, straight + 1e-30f * random.vector(), 0});
        // The face that is ahead, as a box of no thickness.
        glm::vec3 lo(-1), hi(1);
        lo[i % 3] = hi[i % 3] = straight[i % 3];
        lo[(i + 1) % 3] = inside[(i + 1) % 3]; // ends where the ray runs
        lost += !naive::entersBox(lo, hi, inside, straight, naive::kMissed);
    }
    const HitCounts flatHits = countHits(flat, inPlane);
    EXPECT_EQ(flatHits.cpu, 0u);
    EXPECT_EQ(flatHits.device, 0u);
    stress::DeviceSubject device(testDevice());
    const auto tracer = device.tracer(mesh);
    EXPECT_EQ(tracer->countHits(zeros, true), zeros.size());
    EXPECT_EQ(tracer->distances(zeros), tracer->distances(nearly));
    const HitCounts hits = countHits(mesh, zeros);
    EXPECT_EQ(hits.cpu, zeros.size());
    EXPECT_GT(lost, 0u) << "negative control: 0 / 0 in the slab test";
}

/// Weights and distance of 256 random hits against double precision, with the point by the weights
/// where the ray says it is.
TEST_F(HardCases, C13_BarycentricWeights) {
    constexpr double kUlp = 0x1p-23;
    Random random(1113);
    double worst = 0, naiveWorst = 0;
    for (int i = 0; i < 256;) {
        const glm::vec3 a = random.inCube(1), b = random.inCube(1), c = random.inCube(1);
        const float u = random.uniform(0.1f, 0.8f), v = random.uniform(0.1f, 0.9f - u);
        const glm::vec3 target = a + u * (b - a) + v * (c - a), origin = random.inCube(2);
        const glm::vec3 d = target - origin;
        const glm::vec3 n = glm::cross(b - a, c - a);
        // Seen at a slant, or small, the truth itself hangs on the last digit of the corners.
        if (std::abs(glm::dot(n, d)) < 0.5f * glm::length(d) || glm::length(n) < 1) continue;
        ++i;
        const TriangleTruth truth = intersectInDouble(a, b, c, origin, d);
        const auto hit = hitTriangle(a, b, c, PreparedRay(origin, d));
        ASSERT_TRUE(hit) << i;
        worst = std::max({worst, std::abs(hit->t - truth.t), std::abs(hit->b1 - truth.weights[1]),
                          std::abs(hit->b2 - truth.weights[2])});
        const glm::dvec3 byWeights = (1.0 - hit->b1 - hit->b2) * glm::dvec3(a) +
                                     double(hit->b1) * glm::dvec3(b) +
                                     double(hit->b2) * glm::dvec3(c);
        const glm::dvec3 alongRay = glm::dvec3(origin) + double(hit->t) * glm::dvec3(d);
        EXPECT_LT(glm::distance(byWeights, alongRay), 64 * kUlp) << i;
        // Weights by areas of the point on the ray, from a thousand times as far.
        const glm::vec3 far = origin - 1000.0f * d, point = far + (1000 + hit->t) * d;
        const float area = glm::dot(n, n);
        const float b1 = glm::dot(n, glm::cross(point - a, c - a)) / area;
        naiveWorst = std::max(naiveWorst, std::abs(b1 - truth.weights[1]));
    }
    EXPECT_LT(worst, 16 * kUlp);
    EXPECT_GT(naiveWorst, 16 * kUlp) << "negative control: weights of a point far along the ray";
}

} // namespace
} // namespace stromboli::test
