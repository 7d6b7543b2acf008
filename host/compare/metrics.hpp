#pragma once

#include "host/film/film.hpp"
#include "host/film/image_file.hpp"

#include <array>
#include <filesystem>
#include <optional>

namespace stromboli::compare {

// --- Pictures ------------------------------------------------------------------------------------

/// A picture to compare: linear RGB radiance, rows from the top.
struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<glm::dvec3> rgb;
    /// From 8-bit sRGB: values are in [0, 1], and what was brighter is lost.
    bool lowDynamicRange = false;
    /// The film, if the file has means, variances and sample counts.
    std::optional<Film> film;

    Picture() = default;
    Picture(uint32_t w, uint32_t h) : width(w), height(h), rgb(size_t(w) * h) {}
};

/// Reads PNG, JPEG, WebP, BMP and GIF (as sRGB), EXR, HDR or PFM, by the extension. Channels
/// "samples" and "variance.R", ".G",
/// ".B" of an EXR file (`render --aov`) give the film. What has alpha is taken as it is over black,
/// and alpha itself is not compared. Throws UsageError.
Picture readPicture(const std::filesystem::path& path);

/// A picture of the channels of such a file, or of one in memory, which messages call `name`.
/// Throws UsageError.
Picture pictureOf(const FloatImage& image, const std::string& name);

/// The means of a film, with the film itself.
Picture pictureOf(Film film);

/// Pixels with a value that is NaN or infinite.
uint64_t countNotFinite(const Picture& picture);

// --- Metrics -------------------------------------------------------------------------------------

/// Errors of a picture against a reference, over pixels and channels, in linear radiance. Pictures
/// have the same size (std::invalid_argument otherwise) and finite values.
struct LinearErrors {
    double mse = 0; ///< mean of (x - r)^2
    /// Mean of (x - r)^2 / (r^2 + epsilon), epsilon = relativeEpsilon(reference).
    double relMse = 0;
    double epsilon = 0;
    std::array<double, 3> bias{};         ///< mean of x - r, per channel
    std::array<double, 3> relativeBias{}; ///< the same over the channel's mean of r; 0 for 0 / 0
};

/// relMSE (Rousselle et al. 2011) divides by r^2 + epsilon, so that black pixels do not divide by
/// 0. Here epsilon is 0.01 m^2, m the mean of all channels of the reference: pixels darker than a
/// tenth of the mean count by their absolute error, and a scene that is a million times brighter
/// has the same relMSE. In a picture with mean 1 it is the usual 0.01.
double relativeEpsilon(const Picture& reference);

LinearErrors linearErrors(const Picture& reference, const Picture& picture);

/// Share of each pixel in relMSE, its three channels averaged; the mean over the picture is relMse.
std::vector<double> relativeErrorMap(const Picture& reference, const Picture& picture);

/// 10 log10(1 / MSE) dB of the sRGB signals in [0, 1] (not rounded to bytes) at an exposure of
/// `stops`; infinite for equal pictures.
double psnr(const Picture& reference, const Picture& picture, double stops = 0);

/// Mean structural similarity (Wang et al. 2004) of the grey of two pictures' sRGB signals at an
/// exposure of `stops`: Gaussian window of 11 x 11 pixels with sigma 1.5, K1 = 0.01, K2 = 0.03,
/// range 1; windows over the edge repeat the nearest pixel. 1 for equal pictures. Pictures have
/// the same size.
double ssim(const Picture& reference, const Picture& picture, double stops = 0);

} // namespace stromboli::compare
