#pragma once

#include "scene/build/file_place.hpp"
#include "scene/mitsuba/value.hpp"

#include <string_view>

namespace stromboli::mitsuba {

/// Each throws SceneError at `where` for what is none.
/// One number, or three.
RgbValue rgbOf(const build::FilePlace& where, std::string_view text);
/// The same in sRGB, or #rrggbb.
RgbValue srgbOf(const build::FilePlace& where, std::string_view text);
/// One number, or pairs wavelength:value.
SpectrumValue spectrumOf(const build::FilePlace& where, std::string_view text);

} // namespace stromboli::mitsuba
