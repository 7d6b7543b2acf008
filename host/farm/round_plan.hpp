#pragma once

#include "host/farm/film_header.hpp"
#include "host/farm/merge_films.hpp"
#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/layers.hpp"
#include "host/render/picture_noise.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- Plans of rounds -----------------------------------------------------------------------------

/// A round of samples after the first: which pixels get more, and how many.
struct RoundPlan {
    /// The header of the picture and of the rounds before this one. What counts of them are their
    /// checksums, not what is held.
    FilmHeader picture;
    /// By pixel: the samples it has, and those it is to have. The numbers of samples go on, so that
    /// none is taken twice and Sobol points fill each other's gaps.
    std::vector<uint32_t> from, to;

    uint32_t round() const { return picture.rounds() + 1; }
    uint64_t samples() const;
    uint64_t pixels() const; ///< that get some
};

/// The checksum of what a plan asks for and of the plans before it: it is the same for the same
/// plan of the same picture, whoever wrote it.
uint32_t checksumOf(const RoundPlan& plan);

/// A pixel's samples of the round: those from number `from` to `to`, without the last.
struct PlannedPixel {
    uint32_t pixel = 0, from = 0, to = 0;
    auto operator<=>(const PlannedPixel&) const = default;
};

/// What one share takes of a round: some pixels, with all of their samples.
struct PlannedShare {
    FilmHeader header;                ///< of its film
    std::vector<PlannedPixel> pixels; ///< in the order of the picture
};

/// The pixels of a plan lie in tiles, whose order is mixed, and a share has neighbours in that
/// order, so that each has about as much of the costly parts of the picture. Shares are cut by
/// samples: about as many in each.
PlannedShare ofShare(const RoundPlan& plan, const ShareName& share);

/// What comes after the rounds whose films there are.
struct NextRound {
    PictureNoise reached;          ///< the picture's noise until now
    std::optional<RoundPlan> plan; ///< empty: nothing is left to do
};

/// Spreads the samples of the next round as a render of one machine does those of its next pass
/// (NoisePlan): until the noise is at most `noise`; no pixel gets more than `mostSamples`. The same
/// films give the same plan.
class NextRoundPlanner {
  public:
    /// header: of all films together. Throws UsageError if they are incomplete.
    NextRoundPlanner(const FilmHeader& header, double noise, uint32_t mostSamples);
    NextRoundPlanner(const NextRoundPlanner&) = delete; // parts_ knows where it is
    /// The next run of rows, from the top.
    void add(std::span<const SharedPixel> run) { parts_.add(run); }
    /// To be called once, after the last run.
    NextRound finish();

  private:
    void plan(const Film& part, const NoiseEstimate& estimate);

    double noise_;
    uint32_t mostSamples_;
    RoundPlan plan_;
    std::vector<PartNoise> noises_;
    PictureParts parts_;
};

/// Plans the round that follows the films in these files. Throws UsageError if they are incomplete
/// or damaged.
NextRound planNextRound(FilmsToMerge& films, double noise, uint32_t mostSamples);

/// Whether a name ends as that of a plan does: .plan.
bool namesPlan(const std::filesystem::path& path);

/// Replaces the file whole. Throws OutputError.
void writePlan(const std::filesystem::path& file, const RoundPlan& plan);
/// Throws UsageError that names the file if it is none, of another version, damaged or cut short.
RoundPlan readPlan(const std::filesystem::path& file);

// --- Bands of shares -----------------------------------------------------------------------------

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
