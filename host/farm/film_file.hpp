#pragma once

#include "host/core/files.hpp"
#include "host/farm/film_header.hpp"
#include "host/film/film.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

/// A run of a film's pixels as bytes: the kinds of numbers that follow, which are those that are
/// not 0 everywhere, then they, kind by kind, compressed.
std::vector<std::byte> toBytes(std::span<const SharedPixel> run);

/// A run of pixels as their bytes have them, number by number: a tenth of what the pixels take.
class PackedRun {
  public:
    /// A run of pixels that have no samples.
    explicit PackedRun(size_t pixels) : pixels_(pixels) {}
    /// Nothing if the bytes are others.
    static std::optional<PackedRun> fromBytes(std::span<const std::byte> bytes, size_t pixels);

    size_t size() const { return pixels_; }
    /// Adds the pixels from number `first` on to as many sums.
    void addTo(std::span<SharedPixel> sums, size_t first) const;

  private:
    size_t pixels_;
    uint64_t kinds_ = 0; ///< of numbers, those that are not 0 everywhere
    std::vector<std::byte> numbers_;
};

/// Whether a name ends as that of a film does: .film.
bool namesFilm(const std::filesystem::path& path);

/// Writes a film, run by run, to a file that gets its name when it is complete.
class FilmWriter {
  public:
    /// Throws OutputError.
    FilmWriter(const std::filesystem::path& path, const FilmHeader& header);
    /// The next pixels, row by row, and of each the channels of its layers, if the film holds them.
    /// None are wanted where the film is empty.
    void add(std::span<const SharedPixel> pixels, std::span<const float> layers = {});
    /// Throws OutputError, std::logic_error if pixels are missing.
    void finish();

  private:
    void writeRun();

    TemporaryFile file_;
    size_t pixelsPerRun_;
    uint64_t pixelsLeft_;
    std::vector<SharedPixel> run_; ///< not yet written
    std::vector<float> layers_;    ///< of the run
    size_t channels_;
};

struct UnfinishedFilm;

/// Reads a film, run by run: of a film of any size, no more than a run is in memory.
class FilmReader {
  public:
    /// Reads the header. Throws UsageError that names the file if it is none, of another version,
    /// damaged or cut short.
    explicit FilmReader(const std::filesystem::path& path);
    ~FilmReader();
    FilmReader(FilmReader&& other) noexcept;
    FilmReader& operator=(FilmReader&&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const FilmHeader& header() const { return header_; }
    /// The next run of pixels; all of them without samples where the film is empty. Throws
    /// UsageError as above.
    PackedRun next();
    /// The channels of the layers of each pixel of that run, if the film holds them.
    void nextLayers(std::vector<float>& layers);

  private:
    enum class End { Wanted, MayBeMissing };
    FilmReader(const std::filesystem::path& path, End end);
    friend std::optional<UnfinishedFilm> unfinishedFilm(const std::filesystem::path& path);

    std::vector<std::byte> read(uint64_t size);
    std::vector<std::byte> readPart();
    [[noreturn]] void refuse(const std::string& why) const;

    std::filesystem::path path_;
    int descriptor_ = -1;
    uint64_t size_ = 0, position_ = 0;
    FilmHeader header_;
    size_t pixelsPerRun_ = 0;
    uint64_t pixelsLeft_ = 0;
};

} // namespace stromboli
