#pragma once

#include "host/cli/options.hpp"
#include "host/denoise/denoiser.hpp"
#include "host/engine/render_result.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image_file.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/picture_noise.hpp"
#include "scene/model/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stromboli {

// --- Reports -------------------------------------------------------------------------------------

/// What a render did, for the closing lines and --stats.
struct RenderReport {
    RenderResult render;
    double loadSeconds = 0, writeSeconds = 0;
    bool isShare = false; ///< of a picture whose noise shows in all shares together
};

/// "noise about 2 % (95 % range: 1.5 to 2.6 %)", or why it is unknown.
std::string inWords(const PictureNoise& noise);
/// What to say of a picture whose worst pixels (PictureNoise::worstPixels) have half of its squared
/// noise; empty of others.
std::string worstPixelsInWords(const PictureNoise& noise, bool isDenoised);
/// A share in percent, with two digits that say something: 0.0234 is 2.3.
std::string percent(double share);
/// Logs the error of a denoised picture and what was done to it.
void logDenoised(const denoise::Summary& summary);
/// Warns where light is missing by --clamp-indirect.
void sayIfBiased(const Estimator& estimator);
/// Logs time, paths, rays, Mrays/s, samples, noise, and the first rejected sample if there is one.
void logReport(const RenderReport& report, const RenderSettings& settings);
/// Says so if hardly anything can be seen in the picture, and what would help.
void logBrightness(const Brightness& brightness, const Scene& scene, const std::string& file,
                   const ToneMapping& tone);
/// Says which exposure and white balance were found out from the picture, if they were.
void sayWhatWasMetered(const ToneMapping& asked, const ToneMapping& found);
/// Throws OutputError.
void writeStatistics(const std::string& file, const RenderReport& report, const Scene& scene,
                     const RenderSettings& settings);

// --- Files ---------------------------------------------------------------------------------------

/// What a picture's notes tell.
struct PictureOrigin {
    std::string scene;
    uint32_t seed = 0;
    std::string samples, device;
    std::vector<std::string> command; ///< as RenderOptions::command
    std::string noise;                ///< of a picture in rounds; else empty: not said
};
/// Nothing of when or where: the same command makes the same bytes.
PictureNotes pictureNotes(const PictureOrigin& origin);

/// What can be found out of the files of a render before it: names, folders, permissions. Throws
/// UsageError, OutputError.
void checkOutputs(const RenderOptions& options);
/// Whether the disk has room for the files. Throws OutputError.
void checkDiskSpace(const Scene& scene, const RenderSettings& settings,
                    const RenderOptions& options);

/// The pictures and statistics of a render, put together from the films of its bands.
class RenderOutputs {
  public:
    /// What it is told of must outlive it.
    RenderOutputs(const Scene& scene, const RenderSettings& settings, const RenderOptions& options);
    void place(const FinishedBand& band);
    /// Throws OutputError.
    void write(const RenderReport& report) const;

    Brightness brightness() const { return togetherOf(brightness_); }

  private:
    const Scene& scene_;
    const RenderSettings& settings_;
    const RenderOptions& options_;
    PictureFile picture_;
    std::optional<ByteImage> rates_; ///< of a picture in one band
    std::vector<PartBrightness> brightness_;
};

} // namespace stromboli
