#include "host/farm/merge_films.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
#include <sys/resource.h>
#include <utility>

namespace stromboli {
namespace {

/// Each film is open until it is read: as many as the system allows, not as many as it allows
/// programs that do not ask.
void allowManyFiles() {
    rlimit limit = {};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

/// The rows of a run of pixels, from row `first` on.
PictureArea rowsOf(const PictureArea& area, uint32_t first, size_t pixels) {
    const Crop all = area.rendered();
    return {
        area.width, area.height, {all.x, all.y + first, all.width, uint32_t(pixels / all.width)}};
}

/// Whether a film has later passes than another. They are added first: those of earlier ones then
/// change nothing of what is known of the last pass, which saves its sums.
bool isLater(const FilmReader& a, const FilmReader& b) {
    const auto lastOf = [](const FilmReader& film) {
        const FilmHeader& header = film.header();
        return std::pair(header.rounds(), header.blocks.empty() ? 0 : header.blocks.back().end);
    };
    return lastOf(a) > lastOf(b);
}

} // namespace

FilmsToMerge::FilmsToMerge(const std::vector<std::filesystem::path>& files) {
    allowManyFiles();
    std::vector<FilmReader> films;
    for (const std::filesystem::path& file : files) {
        FilmReader film(file);
        if (&file == &files.front()) {
            header_ = film.header();
        } else {
            const std::string difference = differenceOf(header_, film.header());
            if (!difference.empty())
                throw UsageError(fmt::format("{} {}; {} is the first", file.string(), difference,
                                             files.front().string()));
            add(header_, film.header(), file);
        }
        if (!film.header().isEmpty()) films.push_back(std::move(film));
    }
    std::vector<size_t> order(films.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::ranges::sort(order, [&](size_t a, size_t b) { return isLater(films[a], films[b]); });
    for (const size_t i : order)
        films_.push_back(std::move(films[i]));
}

void FilmsToMerge::addUp(const std::function<void(const PictureArea&, std::span<const SharedPixel>,
                                                  std::span<const float>)>& take) {
    const PictureArea& area = header_.settings.area;
    const size_t atOnce = std::clamp<size_t>(
        films_.size(), 1, size_t(std::clamp(tbb::info::default_concurrency(), 1, 16)));
    std::vector<PackedRun> runs(atOnce, PackedRun(0));
    std::vector<SharedPixel> sum;
    std::vector<float> layers;
    const uint32_t rows = area.rendered().height;
    for (uint32_t row = 0; row < rows; row += rowsPerRun(area)) {
        sum.assign(size_t(std::min(rowsPerRun(area), rows - row)) * area.rendered().width, {});
        for (size_t first = 0; first < films_.size(); first += atOnce) {
            const size_t count = std::min(atOnce, films_.size() - first);
            tbb::parallel_for(size_t(0), count, [&](size_t i) {
                FilmReader& film = films_[first + i];
                runs[i] = film.next();
                if (film.header().holdsLayers) film.nextLayers(layers); // one film at most
            });
            tbb::parallel_for(
                tbb::blocked_range<size_t>(0, sum.size(), 1024), [&](const auto& range) {
                    for (size_t k = 0; k < count; ++k)
                        runs[k].addTo(std::span(sum).subspan(range.begin(), range.size()),
                                      range.begin());
                });
        }
        take(rowsOf(area, row, sum.size()), sum, layers);
    }
}

} // namespace stromboli
