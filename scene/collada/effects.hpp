#pragma once

#include "scene/collada/context.hpp"
#include "scene/collada/textures.hpp"

#include <string>
#include <vector>

namespace stromboli::collada {

/// What messages say of surfaces whose material is not there, or says nothing.
inline constexpr const char* kGreyInstead = "mid grey (0.5) takes its place";

/// A texture of a material, for which an instance finds the coordinates.
struct EffectTexture {
    TextureSlot slot = TextureSlot::BaseColor;
    uint32_t texture = 0;
    std::string texcoord{}; ///< the name by which an instance binds them
    float scale = 1;        ///< as TextureUse::scale
};

/// A material whose textures are not bound to coordinates yet.
struct EffectMaterial {
    Material material;
    std::vector<EffectTexture> textures;
};

/// The material an <effect> describes: its dialect if it has one, else its profile_COMMON
/// (constant, lambert, phong, blinn: diffuse reflection, emission, opacity and a coat; what else
/// those models have is reported). Throws SceneError for values that make no sense.
EffectMaterial readEffect(Context& context, Textures& textures, const Element& effect,
                          const std::string& name);

/// A fraction of light per channel (SceneBuilder::reflectedFraction).
glm::vec3 readFraction(Context& context, const Element& at);

/// A radiance or other amount of light (SceneBuilder::lightColor).
glm::vec3 readLightColor(Context& context, const Element& at);

} // namespace stromboli::collada
