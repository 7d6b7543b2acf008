#pragma once

#include "scene/collada/context.hpp"

namespace stromboli::collada {

/// What messages say of surfaces whose material is not there, or says nothing.
inline constexpr const char* kGreyInstead = "mid grey (0.5) takes its place";

/// The material an <effect> describes: its CS184 dialect if it has one, else its profile_COMMON
/// (constant, lambert, phong, blinn: diffuse reflection and emission; everything else those models
/// have is reported). Throws SceneError for values that make no sense.
Material readEffect(Context& context, const Element& effect, const std::string& name);

/// A fraction of light per channel (SceneBuilder::reflectedFraction).
glm::vec3 readFraction(Context& context, const Element& at);

/// A radiance or other amount of light (SceneBuilder::lightColor).
glm::vec3 readLightColor(Context& context, const Element& at);

} // namespace stromboli::collada
