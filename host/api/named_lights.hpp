#pragma once

#include "host/api/named_settings.hpp"
#include "host/api/named_values.hpp"
#include "scene/model/light.hpp"

#include <glm/glm.hpp>

#include <string_view>
#include <vector>

namespace stromboli::api {

/// Changes a parameter of a light of a scene whose world begins at `origin` (Scene::origin):
/// "color", "position", "direction", "angle" or "inner_angle", as LightAsked has them and where the
/// light's kind has a use for them. A colour may be given as one number. Throws UsageError for
/// other names and for values out of range.
void setLight(Light& light, const glm::dvec3& origin, std::string_view parameter,
              const Value& value);

/// Throws UsageError where parameters do not fit each other.
void requireLight(const Light& light);

/// Names and meanings of the parameters that a light has.
std::vector<NamedThing> lightParameters(const Light& light);

} // namespace stromboli::api
