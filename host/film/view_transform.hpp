#pragma once

#include "host/core/text.hpp"

#include <glm/glm.hpp>

#include <array>

namespace stromboli {

/// How radiance, which has no upper bound, becomes the light of a screen, which has.
enum class View { Standard, AgX, Filmic, PbrNeutral };
template <>
inline constexpr auto kNamedValues<View> = std::to_array<NamedValue<View>>({
    {View::Standard, "standard", "what is above white is cut off"},
    {View::AgX, "agx", "bright colours fade to white, as film does (Sobotka; in Blender)"},
    {View::Filmic, "filmic", "each channel by a curve with toe and shoulder (Hable 2010)"},
    {View::PbrNeutral, "pbr-neutral",
     "colours of materials stay as they are, only highlights are compressed (Khronos)"},
});

/// Linear light of a screen in [0, 1] for linear radiance, both with the primaries of Rec. 709. Of
/// the radiance, 1 is what Standard shows as white; the exposure is in it already. Channels that
/// are negative or NaN count as 0, infinite ones as the largest float.
glm::dvec3 displayLight(View view, const glm::dvec3& radiance);

} // namespace stromboli
