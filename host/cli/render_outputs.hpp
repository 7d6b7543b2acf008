#pragma once

#include "host/cli/options.hpp"
#include "host/cli/report.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/image_file.hpp"
#include "host/film/shown_film.hpp"

#include <optional>
#include <vector>

namespace stromboli {

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
