#pragma once

#include "scene/pbrt/forms.hpp"
#include "scene/pbrt/lights.hpp"
#include "scene/pbrt/transforms.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::pbrt {

/// An area light, as the file states it.
struct AreaLightStatement {
    std::string kind;
    Parameters parameters;
};

/// What a shape has of the state in which it stands.
struct ShapeState {
    glm::dmat4 worldFromObject{1.0};
    bool isReversed = false;
    std::shared_ptr<const MaterialStatement> material;
    std::shared_ptr<const AreaLightStatement> light;
    std::shared_ptr<const TextureTable> textures;
    std::shared_ptr<const MaterialTable> materials;
    MediumSides media;
};

/// Something that is placed: once, or wherever its object is.
struct Part {
    build::FilePlace place;
    build::ShapeId shape{};
    glm::dmat4 worldFromObject{1.0};
    uint32_t material = 0;
    std::string name;
};

/// Makes the shapes of a scene.
class Shapes {
  public:
    Shapes(Context& context, Textures& textures, Lights& lights)
        : context_(context), textures_(textures), lights_(lights), materials_(context, textures) {}

    /// Shapes are placed, or become parts of `object` if there is one. Throws SceneError for what
    /// is none.
    void add(const std::string& kind, const Parameters& shape, const ShapeState& state,
             std::vector<Part>* object);
    void place(const Part& part);
    /// Curves that follow each other are one mesh: ends it.
    void finishCurves(std::vector<Part>* object);

  private:
    /// Curves of one state, of which there are often very many.
    struct Curves {
        Form form;
        ShapeState state;
        Parameters shape;
    };

    bool addToCurves(const Form& form, const Parameters& shape, const ShapeState& state,
                     std::vector<Part>* object);
    void addForm(Form form, const std::string& kind, const Parameters& shape,
                 const ShapeState& state, std::vector<Part>* object);
    void fit(const BoundMaterial& material, const ShapeState& state, Form& form);
    std::optional<Pattern> alphaOf(const Parameters& shape, const ShapeState& state);
    double lightArea(Form& form, const ShapeState& state, const std::string& kind);

    Context& context_;
    Textures& textures_;
    Lights& lights_;
    Materials materials_;
    std::optional<Curves> curves_;
};

} // namespace stromboli::pbrt
