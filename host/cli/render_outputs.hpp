#pragma once

#include "host/cli/job.hpp"
#include "host/cli/report.hpp"
#include "host/film/brightness.hpp"
#include "host/film/image_file.hpp"

#include <optional>
#include <vector>

namespace stromboli {

/// Of what a picture's notes tell.
struct PictureOrigin {
    std::string scene;
    uint32_t seed = 0;
    std::string samples, device;
    std::vector<std::string> command; ///< as Options::pictureCommand
    std::string noise;                ///< of a picture in rounds; else empty: not said
};
/// Nothing of when or where: the same command makes the same bytes.
PictureNotes pictureNotes(const PictureOrigin& origin);

/// What can be found out of the files of a render before it: names, folders, permissions. Throws
/// UsageError, OutputError.
void checkOutputs(const Options& options);
/// The same for a disk that would be full.
void checkDiskSpace(const Job& job, const Options& options);

/// The pictures and statistics of a render, put together from the films of its bands.
class RenderOutputs {
  public:
    RenderOutputs(const Job& job, const Options& options);
    /// The band's film, what is known of its noise, and the channels beside its radiance.
    void place(const Film& film, const PictureNoise& noise, const FloatImage& more);
    /// A band that was not begun.
    void leaveOut(const PictureArea& band);
    /// Throws OutputError.
    void write(const RenderReport& report) const;

    PictureNoise noise() const { return togetherOf(noises_); }
    Brightness brightness() const { return togetherOf(brightness_); }

  private:
    const Job& job_;
    const Options& options_;
    PictureFile picture_;
    std::optional<ByteImage> rates_; ///< of a picture in one band
    std::vector<PartNoise> noises_;
    std::vector<PartBrightness> brightness_;
};

} // namespace stromboli
