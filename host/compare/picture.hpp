#pragma once

#include "host/film/film.hpp"
#include "host/film/image_file.hpp"

#include <filesystem>
#include <optional>

namespace stromboli::compare {

/// A picture to compare: linear RGB radiance, rows from the top.
struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<glm::dvec3> rgb;
    /// From 8-bit sRGB: values are in [0, 1], and what was brighter is lost.
    bool lowDynamicRange = false;
    /// With means, variances and sample counts, where the file has them.
    std::optional<Film> film;

    Picture() = default;
    Picture(uint32_t w, uint32_t h) : width(w), height(h), rgb(size_t(w) * h) {}
};

/// Reads PNG (as sRGB), EXR or PFM, by the extension. Channels "samples" and "variance.R", ".G",
/// ".B" of an EXR file (`render --aov`) give the film. What has alpha is taken as it is over black,
/// and alpha itself is not compared. Throws UsageError.
Picture readPicture(const std::filesystem::path& path);

/// The means of a film, with the film itself.
Picture pictureOf(Film film);

/// Pixels with a value that is NaN or infinite.
uint64_t countNotFinite(const Picture& picture);

} // namespace stromboli::compare
