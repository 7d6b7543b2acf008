// Films that are being written, or were cut short.
#include "host/farm/unfinished_film.hpp"

#include "host/core/error.hpp"
#include "host/farm/film_file.hpp"
#include "host/farm/film_marks.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// Whether the file has the first bytes of a film, or fewer of them than its header takes.
bool beginsAsFilm(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string beginning(kFilmMagic.size(), 0);
    stream.read(beginning.data(), std::streamsize(beginning.size()));
    beginning.resize(size_t(stream.gcount()));
    return kFilmMagic.starts_with(beginning);
}

/// Whether the last bytes are those that a complete film ends with.
bool hasEnd(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::string end(kFilmEnd.size(), 0);
    stream.seekg(-std::streamoff(kFilmEnd.size()), std::ios::end);
    return stream.read(end.data(), std::streamsize(end.size())) && end == kFilmEnd;
}

} // namespace

std::string inWords(const UnfinishedFilm& film) {
    if (film.allRows == 0) return "is still being written: nothing of it is complete";
    return fmt::format("is still being written: {} of {} rows are complete", film.rows,
                       film.allRows);
}

std::optional<UnfinishedFilm> unfinishedFilm(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error) || !beginsAsFilm(path) || hasEnd(path))
        return std::nullopt;
    UnfinishedFilm film;
    try {
        FilmReader reader(path, FilmReader::End::MayBeMissing);
        const Crop all = reader.header().settings.area.rendered();
        film.allRows = all.height;
        std::vector<float> layers;
        while (film.rows < film.allRows) {
            const size_t pixels = reader.next().size();
            reader.nextLayers(layers);
            film.rows += uint32_t(pixels / all.width);
        }
    } catch (const UsageError&) { // here it ends
    }
    return film;
}

} // namespace stromboli
