#pragma once

#include "host/api/named_values.hpp"
#include "host/core/text.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_request.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stromboli::api {

// What the value of a setting is meant to be. All throw the UsageError of refuse() for others.

/// Throws UsageError: "name: expected this, not that".
[[noreturn]] void refuse(std::string_view name, const Value& value, const std::string& expected);

std::vector<double> numbers(std::string_view name, const Value& value, size_t count, double least,
                            double most, const std::string& expected);
double number(std::string_view name, const Value& value, double least, double most);
uint32_t whole(std::string_view name, const Value& value, uint32_t least, uint32_t most);
bool yes(std::string_view name, const Value& value);

inline constexpr double kFarthest = 1e18; ///< metres (docs/theory/numerics.md)
glm::dvec3 point(std::string_view name, const Value& value);
const std::string& word(std::string_view name, const Value& value, const std::string& expected);
/// One number for all channels, or three, of at most `most`.
glm::vec3 color(std::string_view name, const Value& value, double most, const std::string& what);
SunRequest sun(std::string_view name, const Value& value);
/// `what`: they name, for messages.
std::vector<std::string> names(std::string_view name, const Value& value, const std::string& what);
std::vector<Layer> layers(std::string_view name, const Value& value);
Roulette roulette(std::string_view name, const Value& value);
Focus focus(std::string_view name, const Value& value);

template <class E>
E choice(std::string_view name, const Value& value) {
    const auto chosen = valueNamed<E>(word(name, value, allNames<E>()));
    if (!chosen) refuse(name, value, allNames<E>());
    return *chosen;
}

} // namespace stromboli::api
