#pragma once

#include "scene/gltf/materials.hpp"

namespace stromboli::gltf {

/// Makes a material of the scene model of an element of `materials`.
class MaterialReader {
  public:
    MaterialReader(Context& context, Textures& textures, const Element& element)
        : context_(context), textures_(textures), at_(element) {}

    Material read();
    /// What its textures want from corners; after read().
    const UvSets& uvSets() const { return uvSets_; }

  private:
    void readBase();
    void readAlpha();
    void readEmission();
    void readTransmission();
    void readScattering();
    void readSpecular();
    void readClearcoat();
    void readSheen();
    void readAnisotropy();
    void readDiffuseTransmission();
    void readDispersion();
    void readIridescence();
    void readSpecularGlossiness();
    void readSpecularGlossinessTexture(const Element& extension, double glossiness);
    void makeUnlit();
    void reportIgnored();

    double fraction(const Element& at, std::string_view member, double otherwise) const;
    glm::vec3 color(const Element& at, std::string_view member, const glm::vec3& otherwise) const;
    void use(const Element& parent, std::string_view member, TextureSlot slot, bool srgb = false);
    void useNormalMap(const Element& parent, std::string_view member, TextureSlot slot);

    Context& context_;
    Textures& textures_;
    const Element at_;
    Material material_;
    UvSets uvSets_;
};

} // namespace stromboli::gltf
