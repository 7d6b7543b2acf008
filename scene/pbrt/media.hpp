#pragma once

#include "scene/build/subsurface.hpp"
#include "scene/pbrt/context.hpp"
#include "scene/pbrt/parameters.hpp"
#include "scene/pbrt/statement.hpp"

#include <glm/glm.hpp>

#include <map>
#include <string>

namespace stromboli::pbrt {

/// What pbrt-v3 takes for a medium that states nothing, per millimetre.
build::Scattering wholeMilk();
/// What a parameter names, or whole milk, which is said.
build::Scattering measured(const Parameters& p, std::string_view parameter,
                           const std::string& name);

/// What is on the two sides of surfaces: numbers of media, or kNoMedium. The outside is where the
/// normal points to.
struct MediumSides {
    uint32_t inside = kNoMedium, outside = kNoMedium;
    bool isStated = false; ///< by a MediumInterface

    auto operator<=>(const MediumSides&) const = default;
};

/// The media of a scene by name.
class Media {
  public:
    explicit Media(Context& context) : context_(context) {}

    /// MakeNamedMedium: grids lie in the coordinates of that place.
    void define(const std::string& name, const Parameters& parameters,
                const glm::dmat4& worldFromMedium);
    /// MediumInterface. A name that is not there is said, and counts as none.
    MediumSides between(const Statement& statement) const;

  private:
    uint32_t named(const Statement& statement, const std::string& name) const;

    Context& context_;
    std::map<std::string, uint32_t> made_;
};

} // namespace stromboli::pbrt
