#pragma once

#include "host/farm/film_header.hpp"
#include "host/farm/round_plan.hpp"
#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/layers.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace stromboli {

/// Part of a picture that a share takes its samples of, and what its film will have of it.
class SharedBand {
  public:
    /// Told how many samples are done since the call before; returning false asks to stop.
    using Progress = std::function<bool(uint64_t samples)>;

    /// The backend was made for this band.
    SharedBand(Backend& backend, const PictureArea& band, Progress progress);

    /// For pictures with alpha: the samples whose camera rays end on a surface are counted, by the
    /// viewer that there is then (of several devices, one may have dropped out).
    void countCovered(const std::function<Viewer*()>& viewer) { viewer_ = viewer; }

    /// The targets' samples from number `first` on, as those of this pass. False if it was stopped.
    bool take(uint32_t first, std::span<const PixelTarget> targets, uint32_t pass);
    /// The blocks of a share of the first round.
    bool takeBlocks(const FilmHeader& header);
    /// What a share of a planned round has here; `firstPixel`: of the band, in the picture.
    bool takePlanned(std::span<const PlannedPixel> pixels, uint32_t firstPixel, uint32_t pass);

    const std::vector<SharedPixel>& sums() const { return sums_; }
    Film film() const;

  private:
    void addCovered(uint32_t firstSample, std::span<const PixelTarget> targets);

    Backend& backend_;
    PictureArea band_;
    Progress progress_;
    std::function<Viewer*()> viewer_; ///< none: no alpha
    std::vector<SharedPixel> sums_;
};

/// Adds what a backend has taken of the targets, from number `firstSample` of each pixel on, as
/// part of pass number `pass`. Throws SceneError if a radiance is out of range.
void addSamples(std::span<SharedPixel> pixels, std::span<const PixelTarget> targets,
                const Film& taken, uint32_t firstSample, uint32_t pass);

} // namespace stromboli
