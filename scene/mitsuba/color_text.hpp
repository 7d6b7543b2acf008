#pragma once

#include "scene/build/file_place.hpp"
#include "scene/mitsuba/value.hpp"

#include <string_view>

namespace stromboli::mitsuba {

/// Each throws SceneError at `where` for what is none.
/// One number, or three.
RgbValue rgbOf(const build::FilePlace& where, std::string_view text);
/// Reads three numbers in sRGB, or #rrggbb.
RgbValue srgbOf(const build::FilePlace& where, std::string_view text);
/// #rrggbb, taken for fractions of 255 of linear light, as Mitsuba 0.x does in <rgb>.
RgbValue hexOf(const build::FilePlace& where, std::string_view text);
/// One number, pairs wavelength:value, or three numbers, which are red, green and blue: as many as
/// Mitsuba 0.x has in its usual build.
Value spectrumOf(const build::FilePlace& where, std::string_view text);
/// A file's lines of wavelength and value; those that begin with # say something else.
SpectrumValue spectrumOfFile(const build::FilePlace& where, std::string_view text);
/// What a black body of a temperature in kelvins, with or without a K behind it, emits, times a
/// scale: W m^-2 sr^-1 nm^-1.
SpectrumValue blackbodyOf(const build::FilePlace& where, std::string_view temperature,
                          std::string_view scale);
SpectrumValue blackbodyOf(double temperature, double scale);

} // namespace stromboli::mitsuba
