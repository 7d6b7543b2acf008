#pragma once

#include "scene/pbrt/statement.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <unordered_map>

namespace stromboli::pbrt {

/// The current transformation, at the start and at the end of the shutter's time.
struct Transforms {
    glm::dmat4 start{1.0}, end{1.0};
    bool changesStart = true, changesEnd = true; ///< what directives change

    bool isMoving() const { return start != end; }
};

/// The directives that change the current transformation, and the coordinate systems by name.
class TransformStack {
  public:
    Transforms current;

    /// False if the directive is none of these. Throws SceneError for what makes no sense.
    bool apply(const Statement& statement);
    void name(const std::string& system, const Transforms& transforms);

  private:
    void multiply(const glm::dmat4& by);
    void set(const glm::dmat4& start, const glm::dmat4& end);

    std::unordered_map<std::string, Transforms> systems_;
};

/// To the world from a camera at `eye` that looks at a point along z, x to the right: left-handed.
/// Throws SceneError at `where` if it has no direction.
glm::dmat4 lookAt(const build::FilePlace& where, const glm::dvec3& eye, const glm::dvec3& at,
                  const glm::dvec3& up);

/// A transformation to a frame at `from` whose z axis leads to `to`. Nothing if that is no
/// direction.
std::optional<glm::dmat4> aimed(const glm::dvec3& from, const glm::dvec3& to);

} // namespace stromboli::pbrt
