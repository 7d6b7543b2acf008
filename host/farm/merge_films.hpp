#pragma once

#include "host/farm/film_file.hpp"

#include <functional>

namespace stromboli {

/// Films of one picture, to be added up in one reading of each.
class FilmsToMerge {
  public:
    /// Opens all of them. Throws UsageError that names the file if one cannot be read, is of
    /// another picture than the first, or holds samples that another holds too.
    explicit FilmsToMerge(const std::vector<std::filesystem::path>& files);

    /// Of all of them together.
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

} // namespace stromboli
