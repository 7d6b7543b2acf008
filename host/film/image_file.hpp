#pragma once

#include "host/film/film.hpp"
#include "host/film/image.hpp"
#include "host/film/picture_area.hpp"
#include "host/film/tone.hpp"

#include <filesystem>

namespace stromboli {

struct PictureOptions {
    ToneCurve tone;          ///< PNG only; an EXR file is linear
    bool statistics = false; ///< EXR only: also the channels "samples" (samples taken) and
                             ///< "variance.R", ".G", ".B" (variance of the mean)
};

/// To be called before a long render. Throws UsageError if the extension is neither .png nor
/// .exr (in any case of letters), OutputError if no file can be written there.
void checkWritable(const std::filesystem::path& path);

/// The means of a part of the film (width 0: all of it) as bytes.
ByteImage toneMap(const Film& film, const Crop& crop, const ToneCurve& tone);

/// The means of a part of the film (width 0: all of it) in the channels R, G, B, and the
/// statistics of PictureOptions if asked for.
FloatImage linearPicture(const Film& film, const Crop& crop, bool statistics);

/// Writes a part of the film (width 0: all of it) as PNG or EXR, by the extension, complete or
/// not at all. Throws UsageError (extension, crop) or OutputError.
void writePicture(const std::filesystem::path& path, const Film& film, const Crop& crop,
                  const PictureOptions& options);

} // namespace stromboli
