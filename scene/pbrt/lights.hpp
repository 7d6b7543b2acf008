#pragma once

#include "scene/pbrt/environment.hpp"
#include "scene/pbrt/materials.hpp"

#include <functional>
#include <string>

namespace stromboli::pbrt {

/// The lights of a scene that belong to no shape, and what area lights make of shapes.
class Lights {
  public:
    Lights(Context& context, Textures& textures)
        : context_(context), textures_(textures), surroundings_(context) {}

    /// Throws SceneError for a kind that is none.
    void place(const std::string& kind, const Parameters& light, const glm::dmat4& worldFromLight);
    /// What a shape emits; `area`: of one of the surfaces that pbrt makes lights of.
    Emission emission(const std::string& kind, const Parameters& light, double area);
    void finish() { surroundings_.finish(); }

  private:
    /// Intensity by direction, in the frame of a lamp.
    using Intensity = std::function<glm::dvec3(const glm::dvec3&)>;

    void placePoint(const Parameters& light, const glm::dmat4& worldFromLight);
    void placeDistant(const Parameters& light, const glm::dmat4& worldFromLight);
    void placeSpot(const Parameters& light, const glm::dmat4& worldFromLight);
    void placeGoniometric(const Parameters& light, const glm::dmat4& worldFromLight);
    void placeProjection(const Parameters& light, const glm::dmat4& worldFromLight);
    glm::dvec3 colorOfLight(const Parameters& light, const char* name);
    uint32_t sideOfPicture(uint32_t usual) const;
    void placeProjector(const std::string& name, const Intensity& intensity,
                        const glm::dmat4& worldFromLamp, const glm::dvec2& tangents,
                        const glm::uvec2& texels);
    void placeAllAround(const std::string& name, const Intensity& intensity,
                        const glm::dmat4& worldFromLamp);

    Context& context_;
    Textures& textures_;
    Surroundings surroundings_;
};

} // namespace stromboli::pbrt
