#include "host/farm/merge_films.hpp"

#include "host/core/error.hpp"
#include "host/film/image_file.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <numeric>
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

FilmsToMerge::FilmsToMerge(
    const std::vector<std::filesystem::path>& files,
    const std::function<void(const std::filesystem::path&, const UnfinishedFilm&)>& leaveOut) {
    allowManyFiles();
    std::vector<FilmReader> films;
    const std::filesystem::path* first = nullptr;
    for (const std::filesystem::path& file : files) {
        if (leaveOut)
            if (const std::optional<UnfinishedFilm> unfinished = unfinishedFilm(file)) {
                leaveOut(file, *unfinished);
                continue;
            }
        FilmReader film(file);
        if (!first) {
            first = &file;
            header_ = film.header();
        } else {
            const std::string difference = differenceOf(header_, film.header());
            if (!difference.empty())
                throw UsageError(fmt::format("{} {}; {} is the first", file.string(), difference,
                                             first->string()));
            add(header_, film.header(), file);
        }
        if (!film.header().isEmpty()) films.push_back(std::move(film));
    }
    if (!first) throw UsageError("none of the films is complete yet");
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

namespace {

/// How many runs, of 65,536 pixels each, make a part.
constexpr uint32_t kRunsPerPart = 64;

} // namespace

PictureParts::PictureParts(const FilmHeader& header, Take take)
    : header_(header), take_(std::move(take)), rowsLeft_(header.settings.area.rendered().height) {}

void PictureParts::begin() {
    const PictureArea& area = header_.settings.area;
    const Crop all = area.rendered();
    const uint64_t atMost = uint64_t(rowsPerRun(area)) * kRunsPerPart;
    const auto rows = uint32_t(std::min<uint64_t>(atMost, rowsLeft_));
    part_ = Film(PictureArea{
        area.width, area.height, {all.x, all.y + all.height - rowsLeft_, all.width, rows}});
    part_.branches = header_.settings.estimator.branches;
    errors_.counts.resize(part_.pixels.size());
    errors_.means.resize(part_.pixels.size());
    errors_.squaredErrors.resize(part_.pixels.size());
    more_ = FloatImage(part_.area);
    rowsLeft_ -= rows;
    next_ = 0;
}

void PictureParts::addChannels(std::span<const SharedPixel> run, std::span<const float> layers) {
    if (header_.hasAlpha()) {
        std::vector<float>& alpha = more_.channel(kAlphaChannel);
        for (size_t i = 0; i < run.size(); ++i)
            alpha[next_ + i] = run[i].alpha();
    }
    const size_t channels = header_.layerChannels();
    size_t channel = 0;
    for (const Layer layer : header_.layers)
        for (const std::string& name : channelsOf(layer)) {
            std::vector<float>& values = more_.channel(name);
            for (size_t i = 0; i < run.size() && !layers.empty(); ++i)
                values[next_ + i] = layers[i * channels + channel];
            ++channel;
        }
}

void PictureParts::add(std::span<const SharedPixel> run, std::span<const float> layers) {
    if (next_ == part_.pixels.size()) begin();
    tbb::parallel_for(tbb::blocked_range<size_t>(0, run.size(), 1024), [&](const auto& range) {
        for (size_t i = range.begin(); i != range.end(); ++i) {
            const PixelStatistics p = run[i].all.statistics();
            part_.pixels[next_ + i] = p;
            errors_.counts[next_ + i] = p.count;
            errors_.means[next_ + i] = p.mean;
            errors_.squaredErrors[next_ + i] = run[i].squaredError();
        }
    });
    addChannels(run, layers);
    next_ += run.size();
    if (next_ < part_.pixels.size()) return;
    NoiseEstimate estimate;
    estimate.remember(std::move(errors_));
    take_(part_, estimate, more_);
    errors_ = {};
}

} // namespace stromboli
