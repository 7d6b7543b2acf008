#pragma once

#include "host/farm/film_file.hpp"
#include "host/farm/film_header.hpp"
#include "host/farm/unfinished_film.hpp"
#include "host/film/film.hpp"
#include "host/film/image_file.hpp"
#include "host/render/picture_noise.hpp"

#include <functional>
#include <span>

namespace stromboli {

/// Films of one picture, to be added up in one reading of each.
class FilmsToMerge {
  public:
    /// Opens all of them. Throws UsageError that names the file if one cannot be read, is of
    /// another picture than the first, or holds samples that another holds too.
    /// leaveOut: told of each file that is still being written, which is left out; empty: that is
    /// an error. So it is if none is complete.
    explicit FilmsToMerge(const std::vector<std::filesystem::path>& files,
                          const std::function<void(const std::filesystem::path& file,
                                                   const UnfinishedFilm& film)>& leaveOut = {});

    /// The header of the film that they make together.
    const FilmHeader& header() const { return header_; }

    /// Calls `take` with the sum of each run of pixels, from the top of the picture, and the part
    /// of the picture that it is; and with the channels of its layers, if a film holds them. To be
    /// called once. Throws UsageError if a film is damaged.
    void addUp(const std::function<void(const PictureArea& part, std::span<const SharedPixel> run,
                                        std::span<const float> layers)>& take);

  private:
    std::vector<FilmReader> films_;
    FilmHeader header_;
};

/// The statistics of a picture whose films are added up run by run, in parts that are large enough
/// for their noise to mean something, and no larger than four million pixels: what memory holds.
/// The parts follow from the picture's size alone, and so does what is worked out from them.
class PictureParts {
  public:
    /// `estimate` knows the errors of the part's pixels; `more`: its alpha and layers, as far as
    /// the picture has them and films hold them.
    using Take = std::function<void(const Film& part, const NoiseEstimate& estimate,
                                    const FloatImage& more)>;

    PictureParts(const FilmHeader& header, Take take);
    /// The next run of rows, from the top. Calls `take` for each part that is whole.
    void add(std::span<const SharedPixel> run, std::span<const float> layers = {});

  private:
    void begin();
    void addChannels(std::span<const SharedPixel> run, std::span<const float> layers);

    FilmHeader header_;
    Take take_;
    uint32_t rowsLeft_; ///< of the picture
    Film part_;
    NoiseEstimate::Memory errors_;
    FloatImage more_;
    size_t next_ = 0; ///< pixel of the part
};

} // namespace stromboli
