#pragma once

#include "scene/pbrt/context.hpp"
#include "scene/pbrt/media.hpp"
#include "scene/pbrt/shapes.hpp"
#include "scene/pbrt/transforms.hpp"
#include "scene/pbrt/view.hpp"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::pbrt {

/// Carries out the statements of a scene, one after the other.
class SceneReader {
  public:
    explicit SceneReader(Context& context)
        : context_(context), view_(context), textures_(context), lights_(context, textures_),
          shapes_(context, textures_, lights_), media_(context) {}

    void read(std::vector<Statement> statements);

  private:
    /// What AttributeBegin keeps and AttributeEnd brings back, beside the transformation.
    struct State {
        bool isReversed = false;
        std::shared_ptr<const MaterialStatement> material;
        std::shared_ptr<const AreaLightStatement> light;
        std::shared_ptr<const TextureTable> textures = std::make_shared<TextureTable>();
        std::shared_ptr<const MaterialTable> materials = std::make_shared<MaterialTable>();
        std::string colorSpace = "srgb";
        MediumSides media;
        std::map<std::string, std::vector<Parameter>> attributes; ///< by what they are of
    };
    struct Saved {
        State state;
        Transforms transforms;
        std::string_view by; ///< the directive that ends it
    };

    void carryOut(const Statement& statement);
    bool changeState(const Statement& statement);
    void begin(std::string_view end);
    void end(const Statement& statement);
    void beginWorld();
    void beginObject(const Statement& statement);
    void endObject(const Statement& statement);
    void placeObject(const Statement& statement);
    void defineTexture(const Statement& statement);
    void setMaterial(const Statement& statement);
    void nameMaterial(const Statement& statement);
    void useMaterial(const Statement& statement);
    void setAreaLight(const Statement& statement);
    void placeLight(const Statement& statement);
    void addShape(const Statement& statement);
    void readView(const Statement& statement);
    void defineMedium(const Statement& statement);
    void setMedia(const Statement& statement);
    void sayVolume(const Statement& statement);
    std::shared_ptr<const MaterialStatement> materialOf(std::string kind, Parameters parameters);
    /// The parameters of a statement, with those that Attribute has for things of this sort.
    Parameters parametersOf(const Statement& statement, const char* sort);
    glm::dmat4 worldFromObject(const Statement& statement);
    std::vector<Part>* openObject() {
        return objectName_.empty() ? nullptr : &objects_[objectName_];
    }

    Context& context_;
    View view_;
    Textures textures_;
    Lights lights_;
    Shapes shapes_;
    Media media_;
    State state_;
    TransformStack transforms_;
    std::vector<Saved> saved_;
    std::map<std::string, std::vector<Part>> objects_;
    std::string objectName_; ///< of the one that is being defined, with a mark before it
    bool isInWorld_ = false;
    std::map<std::string, const Statement*> definitions_; ///< of named materials, the first ones
};

} // namespace stromboli::pbrt
