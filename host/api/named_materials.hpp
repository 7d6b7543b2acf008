#pragma once

#include "host/api/named_settings.hpp"
#include "host/api/named_values.hpp"
#include "scene/model/material.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stromboli::api {

/// A material of this kind with what that has where nothing is said. Throws UsageError, which names
/// the kinds, for any other.
Material makeMaterial(std::string_view kind, std::string name);

/// Changes a parameter of a material: those of its kind and "emission". A colour may be given as
/// one number. Throws UsageError for names that the kind does not have and values out of range.
void setMaterial(Material& material, std::string_view parameter, const Value& value);

/// The value of a parameter, as setMaterial() takes it.
std::vector<double> materialValue(const Material& material, std::string_view parameter);

/// Names of the kinds, and the names of the parameters that a kind has.
std::vector<std::string> materialKinds();
std::string_view kindOf(const Material& material);
std::vector<NamedThing> materialParameters(std::string_view kind);

} // namespace stromboli::api
