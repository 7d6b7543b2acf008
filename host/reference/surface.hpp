#pragma once

#include "host/reference/bvh.hpp"
#include "host/render/estimator.hpp"
#include "scene/model/scene.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace stromboli::reference {

/// What the path needs to know of the point it hit.
struct SurfacePoint {
    glm::dvec3 position{0.0}; ///< on the flat triangle, or the sphere
    /// Bound of the distance between `position` and the plane or sphere it lies on, for that
    /// surface and all that coincide with it.
    double error = 0;
    glm::dvec3 geometric{0, 0, 1}; ///< unit; as stored, see faceForward()
    glm::dvec3 shading{0, 0, 1};   ///< unit; interpolated, or the geometric one
    glm::dvec3 wo{0, 0, 1};        ///< unit, back along the ray
    bool outside = true;           ///< wo is on the side the stored geometric normal points to
    /// Height of the smooth surface over `position` along the geometric normal that faces wo, and
    /// from which light is reflected; faceForward() may put it on the flat one.
    double lift = 0;
    uint32_t primitive = kNoPrimitive;
    uint32_t triangle = kNoPrimitive; ///< the primitive if it is planar: rays that leave it miss it
    /// Its parameters at this point, with textures and the colours of corners taken in.
    const Material* material = nullptr;
    const Material* stated = nullptr;            ///< the scene's: it outlives the point
    std::shared_ptr<const Material> ownMaterial; ///< `material`, where it is not the scene's
    /// The other materials of the mixture that `material` was drawn from, where they scatter with
    /// it (areEvaluatedTogether()), and the shares of these and of `material`: 1 in all.
    struct Part {
        std::shared_ptr<const Material> material;
        double share = 0;
    };
    std::vector<Part> others;
    double share = 1;
    bool isFromBehind = false; ///< isSeenFromBehind() before faceForward()
    /// Unit, perpendicular to the shading normal, along which u grows; w: the bitangent is
    /// w (shading normal x tangent), 0: there is none.
    glm::dvec4 tangent{0.0};
    glm::dvec3 unmapped{0, 0, 1};   ///< shading normal before a map turned it, where one may have
    std::optional<glm::dvec3> coat; ///< unit; the clear coat's normal, where it has one of its own
    /// The point is in this medium and on no surface: it has no normals, and scatters by the phase
    /// function.
    const Medium* medium = nullptr;
    double b1 = 0, b2 = 0; ///< barycentric weights of the second and third corner
};

/// Normals as the scene states them. The hit is one of the scene's.
SurfacePoint surfaceAt(const Scene& scene, const Ray& ray, const Hit& hit);

/// A triangle with the normals of its corners, which may be on either side of it.
struct SmoothTriangle {
    glm::dvec3 corner[3], normal[3]; ///< normals: unit

    /// How far the smooth surface is in front of the point with these barycentric weights, `front`
    /// being one of the two unit normals of the plane; 0 where it is behind, or where not all
    /// corner normals are on one side of the plane. The sum, over the edges where the mesh bulges
    /// forward, of b_i b_j (n_i - n_j) . (v_i - v_j): docs/theory/numerics.md, "Shading normals and
    /// the terminator", after Hanika 2021.
    double height(const glm::dvec3& weights, const glm::dvec3& front) const;
};

/// Turns the geometric normal to the side of wo and the shading normal to that of the geometric
/// one; where wo is then below the shading normal's horizon, the geometric one takes its place.
/// Where conventions do not face forward, this only takes the lift away.
void faceForward(SurfacePoint& surface, const ShadingConventions& conventions);

/// Whether the surface, its normals as stated, is seen from where its shading normals do not point.
bool isSeenFromBehind(const SurfacePoint& surface);

class RandomStream;

/// Draws which material of a mixture light meets there, and notes those that scatter with it.
void drawMaterial(SurfacePoint& surface, const Scene& scene, RandomStream& random);
/// The material of the side that the surface is seen from, for those who draw none of a mixture.
void takeMaterialOfSide(SurfacePoint& surface, const Scene& scene);
/// Takes in textures and the colours of corners: the material's parameters, as stated before
/// faceForward().
void applyTextures(SurfacePoint& surface, const Scene& scene);
/// After faceForward(): the shading normal by heights or the normal map, and the tangent.
void applyNormalMap(SurfacePoint& surface, const Scene& scene,
                    const ShadingConventions& conventions);

/// A shading normal n, bent towards wo so far that the mirror direction of wo is on the horizon of
/// the geometric normal g, if it is below; wo is above (Keller et al. 2017, A.3).
glm::dvec3 bendNormal(const glm::dvec3& n, const glm::dvec3& g, const glm::dvec3& wo);

/// The point moved by its error bound along n (unit) to the side of `direction`, so that nothing
/// that coincides with the surface lies ahead of a ray from there in that direction.
glm::dvec3 moveOff(const glm::dvec3& position, double error, const glm::dvec3& n,
                   const glm::dvec3& direction);

/// The point that light is reflected from: on the smooth surface. The surface is faced forward.
glm::dvec3 litPoint(const SurfacePoint& surface);

/// Whether light can be reflected towards w: not through the plane of a flat surface. What is below
/// the plane of a smooth one is for rays from litPoint() to find out, which can hit that plane.
bool isReflected(const SurfacePoint& surface, const glm::dvec3& w);

/// The ray that leaves the surface, reflected, in a unit direction.
Ray reflectedRay(const SurfacePoint& surface, const glm::dvec3& direction);
/// The ray that leaves the surface on its other side, in a unit direction: light that goes through
/// it.
Ray transmittedRay(const SurfacePoint& surface, const glm::dvec3& direction);
/// What a reflected ray cannot hit: the plane it starts on, but not one that it starts above.
uint32_t startOfReflected(const SurfacePoint& surface);

/// Radiance the surface emits towards wo.
glm::dvec3 emission(const SurfacePoint& surface);

/// Error bound of a point computed on the triangle with these corners: see SurfacePoint::error.
double errorOnTriangle(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2);
/// Error bound of a point computed as center + radius * unit vector.
double errorOnSphere(const glm::dvec3& center, double radius);

/// Unit, on the side from which the corners are counter-clockwise.
glm::dvec3 triangleNormal(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2);

} // namespace stromboli::reference
