#pragma once

#include "scene/images/float_image.hpp"
#include "scene/pbrt/context.hpp"
#include "scene/pbrt/parameters.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli::pbrt {

/// A direction of the unit sphere for a place in [0, 1]^2: P. Clarberg, "Fast Equal-Area Mapping of
/// the (Hemi)Sphere using SIMD", 2008. pbrt-v4's pictures of all around are of this kind.
glm::dvec3 directionOfSquare(const glm::dvec2& place);
glm::dvec2 squareOfDirection(const glm::dvec3& direction);

/// A picture of all directions around, by the angles of the frame of its light: z up in the first
/// row of pbrt-v3's, or on a square.
struct DirectionMap {
    images::FloatImage image;
    bool isSquare = false;

    glm::dvec3 at(const glm::dvec3& direction) const;
};
/// Says what is wrong with it. Throws SceneError if it cannot be read.
DirectionMap readDirectionMap(Context& context, const Parameters& light, const std::string& name);

/// All light from infinity of a scene, which becomes one environment.
class Surroundings {
  public:
    explicit Surroundings(Context& context) : context_(context) {}

    /// A light of the kind "infinite".
    void add(const Parameters& light, const glm::dmat4& worldFromLight);
    void finish();

  private:
    void addPortal(const Parameters& light);
    struct Map {
        DirectionMap picture;
        glm::dmat3 lightFromWorld;
        glm::dvec3 factor{1.0};
        std::string name;
    };

    bool setUpright(const Map& map);
    void resample();

    Context& context_;
    glm::dvec3 constant_{0.0};
    bool isThere_ = false;
    std::vector<Map> maps_;
};

} // namespace stromboli::pbrt
