#include "host/farm/round_plan.hpp"

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/render/sampling_plan.hpp"
#include "host/render/settings.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

namespace stromboli {

// --- Plans of rounds -----------------------------------------------------------------------------

// A plan: kPlanMagic; the header of its picture, after its size; the numbers of samples that pixels
// have, then those they are to have, compressed; and a checksum of all that.

namespace {

/// Side of a tile in pixels: what the kernel's lanes take side by side stays together.
constexpr uint32_t kTileSide = 8;

/// A permutation of 32 bits that leaves no order behind (the end of MurmurHash3, Appleby 2011).
uint32_t mixed(uint32_t bits) {
    bits = (bits ^ bits >> 16) * 0x85EBCA6Bu;
    bits = (bits ^ bits >> 13) * 0xC2B2AE35u;
    return bits ^ bits >> 16;
}

/// The pixels that get samples, in the order in which shares have them.
std::vector<PlannedPixel> inOrderOfShares(const RoundPlan& plan) {
    const uint32_t width = plan.picture.settings.area.rendered().width;
    const uint32_t tilesAcross = (width + kTileSide - 1) / kTileSide;
    std::vector<std::pair<uint32_t, PlannedPixel>> byTile;
    for (uint32_t i = 0; i < plan.from.size(); ++i)
        if (plan.to[i] > plan.from[i])
            byTile.push_back({mixed(i / width / kTileSide * tilesAcross + i % width / kTileSide),
                              {i, plan.from[i], plan.to[i]}});
    std::ranges::sort(byTile);
    std::vector<PlannedPixel> pixels(byTile.size());
    std::ranges::transform(byTile, pixels.begin(), [](const auto& entry) { return entry.second; });
    return pixels;
}

/// The first place of a share, or the number of all behind the last one: where its part of the
/// samples begins.
uint32_t firstPlaceOf(const std::vector<uint64_t>& samplesBefore, uint32_t share, uint32_t shares) {
    const auto begin = uint64_t(uint128(samplesBefore.back()) * (share - 1) / shares);
    return uint32_t(std::ranges::lower_bound(samplesBefore, begin) - samplesBefore.begin());
}

} // namespace

uint64_t RoundPlan::samples() const {
    uint64_t sum = 0;
    for (size_t i = 0; i < from.size(); ++i)
        sum += to[i] - from[i];
    return sum;
}

uint64_t RoundPlan::pixels() const {
    uint64_t count = 0;
    for (size_t i = 0; i < from.size(); ++i)
        count += to[i] > from[i];
    return count;
}

uint32_t checksumOf(const RoundPlan& plan) {
    std::vector<std::byte> bytes;
    for (const PlannedRound& round : plan.picture.planned)
        append(bytes, round.plan);
    append(bytes, plan.round());
    append(bytes, plan.from.data(), plan.from.size() * sizeof(uint32_t));
    append(bytes, plan.to.data(), plan.to.size() * sizeof(uint32_t));
    return checksumOf(std::span<const std::byte>(bytes));
}

PlannedShare ofShare(const RoundPlan& plan, const ShareName& share) {
    PlannedShare result{plan.picture, inOrderOfShares(plan)};
    std::vector<uint64_t> samplesBefore(result.pixels.size() + 1, 0); // of each place, and of all
    std::transform_inclusive_scan(
        result.pixels.begin(), result.pixels.end(), samplesBefore.begin() + 1, std::plus<>(),
        [](const PlannedPixel& pixel) { return uint64_t(pixel.to - pixel.from); });
    const uint32_t first = firstPlaceOf(samplesBefore, share.index, share.count);
    const uint32_t end = firstPlaceOf(samplesBefore, share.index + 1, share.count);

    FilmHeader& header = result.header;
    header.shares.clear();
    header.blocks.clear();
    header.holdsLayers = false;
    for (PlannedRound& round : header.planned)
        round = {round.plan, round.samples, 0, {}, {}};
    PlannedRound& round = header.planned.emplace_back();
    round.plan = checksumOf(plan);
    round.samples = samplesBefore.back();
    round.held = samplesBefore[end] - samplesBefore[first];
    round.shares = {share};
    if (first < end) round.places = {{first, end}};

    result.pixels = {result.pixels.begin() + first, result.pixels.begin() + end};
    std::ranges::sort(result.pixels);
    return result;
}

NextRoundPlanner::NextRoundPlanner(const FilmHeader& header, double noise, uint32_t mostSamples)
    : noise_(noise), mostSamples_(mostSamples),
      parts_(header, [this](const Film& part, const NoiseEstimate& estimate, const FloatImage&) {
          plan(part, estimate);
      }) {
    if (!header.isComplete())
        throw UsageError(fmt::format("the next round cannot be planned: {}", missingFrom(header)));
    plan_.picture = header;
    plan_.picture.shares.clear();
    plan_.picture.blocks.clear();
    plan_.picture.holdsLayers = false;
    for (PlannedRound& round : plan_.picture.planned)
        round = {round.plan, round.samples, 0, {}, {}};
}

void NextRoundPlanner::plan(const Film& part, const NoiseEstimate& estimate) {
    noises_.push_back({estimate.picture(part), part.pixels.size()});
    const size_t first = plan_.from.size();
    for (const PixelStatistics& p : part.pixels) {
        plan_.from.push_back(p.taken());
        plan_.to.push_back(p.taken());
    }
    const NoisePlan rule(mostSamples_, part.branches);
    for (const PixelTarget& target :
         rule.next(part, estimate, std::numeric_limits<uint64_t>::max(), noise_))
        plan_.to[first + target.pixel] = target.samples;
}

NextRound NextRoundPlanner::finish() {
    NextRound next{togetherOf(noises_), std::nullopt};
    if (plan_.samples() > 0) next.plan = std::move(plan_);
    return next;
}

NextRound planNextRound(FilmsToMerge& films, double noise, uint32_t mostSamples) {
    NextRoundPlanner planner(films.header(), noise, mostSamples);
    films.addUp([&](const PictureArea&, std::span<const SharedPixel> run, std::span<const float>) {
        planner.add(run);
    });
    return planner.finish();
}

namespace {

namespace fs = std::filesystem;

/// Changes with every change of what is written.
constexpr std::string_view kPlanMagic = "stromboli plan 1\n";

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
    throw UsageError(fmt::format("{}: {}", file.string(), why));
}

std::vector<std::byte> contentOf(const fs::path& file) {
    std::error_code failed;
    if (!fs::exists(file, failed)) refuse(file, "there is no such plan");
    const uintmax_t size = fs::file_size(file, failed);
    std::ifstream stream(file, std::ios::binary);
    if (failed || !stream) refuse(file, "cannot read the plan");
    std::vector<std::byte> bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    if (!stream) refuse(file, "cannot read the plan");
    return bytes;
}

/// What no plan says that this program wrote.
bool isPossible(const RoundPlan& plan) {
    for (size_t i = 0; i < plan.from.size(); ++i)
        if (plan.from[i] > plan.to[i] || plan.to[i] > kMostSamples) return false;
    return plan.samples() > 0;
}

} // namespace

bool namesPlan(const fs::path& path) {
    return path.extension() == ".plan";
}

void writePlan(const fs::path& file, const RoundPlan& plan) {
    std::vector<std::byte> bytes;
    append(bytes, kPlanMagic.data(), kPlanMagic.size());
    const std::vector<std::byte> picture = toBytes(plan.picture);
    append(bytes, uint64_t(picture.size()));
    append(bytes, picture.data(), picture.size());
    std::vector<std::byte> numbers;
    append(numbers, plan.from.data(), plan.from.size() * sizeof(uint32_t));
    append(numbers, plan.to.data(), plan.to.size() * sizeof(uint32_t));
    const std::vector<std::byte> small = compressed(numbers);
    append(bytes, small.data(), small.size());
    append(bytes, checksumOf(bytes));
    writeFileAtomically(file, bytes);
}

RoundPlan readPlan(const fs::path& file) {
    const std::vector<std::byte> bytes = contentOf(file);
    if (bytes.size() < kPlanMagic.size() ||
        std::memcmp(bytes.data(), kPlanMagic.data(), kPlanMagic.size()) != 0)
        refuse(file, "not a plan of this version of the program");
    const size_t end = bytes.size() - std::min(bytes.size(), sizeof(uint32_t));
    ByteParts sum(file, "plan", std::span(bytes).subspan(end));
    if (sum.number<uint32_t>() != checksumOf(std::span(bytes).first(end)))
        refuse(file, "the plan is damaged or cut short");
    ByteParts parts(file, "plan", std::span(bytes).first(end));
    parts.take(kPlanMagic.size());
    RoundPlan plan;
    plan.picture = filmHeaderFromBytes(parts.take(parts.number<uint64_t>()), file);
    const uint64_t pixels = plan.picture.settings.area.pixelCount();
    const std::optional<std::vector<std::byte>> numbers =
        decompressed(parts.rest(), 2 * pixels * sizeof(uint32_t));
    if (!numbers) refuse(file, "the plan is damaged");
    plan.from.resize(pixels);
    plan.to.resize(pixels);
    std::memcpy(plan.from.data(), numbers->data(), pixels * sizeof(uint32_t));
    std::memcpy(plan.to.data(), numbers->data() + pixels * sizeof(uint32_t),
                pixels * sizeof(uint32_t));
    if (!isPossible(plan)) refuse(file, "the plan makes no sense");
    return plan;
}

// --- Bands of shares -----------------------------------------------------------------------------

namespace {

std::vector<PixelTarget> allPixels(const PictureArea& area, uint32_t samples) {
    std::vector<PixelTarget> targets(area.pixelCount());
    for (uint32_t i = 0; i < targets.size(); ++i)
        targets[i] = {i, samples};
    return targets;
}

} // namespace

SharedBand::SharedBand(Backend& backend, const PictureArea& band, Progress progress)
    : backend_(backend), band_(band), progress_(std::move(progress)), sums_(band.pixelCount()) {}

bool SharedBand::take(uint32_t first, std::span<const PixelTarget> targets, uint32_t pass) {
    Film film(band_);
    bool goesOn = true;
    uint64_t told = 0;
    backend_.beginAt(first);
    backend_.sample(targets, film, [&](uint64_t done) {
        // One of several devices may be lost with what it had said to be done, so `done` may fall.
        const uint64_t more = done > told ? done - told : 0;
        told = std::max(told, done);
        return goesOn = progress_(more) && goesOn;
    });
    if (!goesOn) return false;
    addSamples(sums_, targets, film, first, pass);
    if (viewer_) addCovered(first, targets);
    return true;
}

bool SharedBand::takeBlocks(const FilmHeader& header) {
    const SampleBlocks all = header.allBlocks();
    for (const BlockRange& range : header.blocks)
        for (uint32_t block = range.first; block < range.end; ++block) {
            const uint32_t first = all.firstOf(block);
            const uint32_t samples = all.firstOf(block + 1) - first;
            if (!take(first, allPixels(band_, samples), header.passOf(block))) return false;
        }
    return true;
}

/// Pixels that have as many samples until now go together: there are few such numbers.
bool SharedBand::takePlanned(std::span<const PlannedPixel> pixels, uint32_t firstPixel,
                             uint32_t pass) {
    std::map<uint32_t, std::vector<PixelTarget>> alike;
    for (const PlannedPixel& p : pixels)
        alike[p.from].push_back({p.pixel - firstPixel, p.to - p.from});
    for (const auto& [first, targets] : alike)
        if (!take(first, targets, pass)) return false;
    return true;
}

Film SharedBand::film() const {
    Film film(band_);
    for (size_t i = 0; i < sums_.size(); ++i)
        film.pixels[i] = sums_[i].all.statistics();
    return film;
}

/// By the camera rays of the very samples.
void SharedBand::addCovered(uint32_t firstSample, std::span<const PixelTarget> targets) {
    std::vector<uint32_t> samples(sums_.size(), 0);
    for (const PixelTarget& t : targets)
        samples[t.pixel] = t.samples;
    for (size_t begin = 0; begin < samples.size(); begin += Viewer::kMostSeenAtOnce) {
        const std::span<const uint32_t> run = std::span(samples).subspan(
            begin, std::min<size_t>(Viewer::kMostSeenAtOnce, samples.size() - begin));
        if (std::ranges::count(run, 0u) == std::ssize(run)) continue;
        const auto seen = viewer_()->see(uint32_t(begin), run, Seeing::Coverage, firstSample);
        for (size_t i = 0; i < seen.size(); ++i)
            sums_[begin + i].covered += seen[i].hits;
    }
}

void addSamples(std::span<SharedPixel> pixels, std::span<const PixelTarget> targets,
                const Film& taken, uint32_t firstSample, uint32_t pass) {
    constexpr size_t kTargetsAtOnce = 4096;
    tbb::parallel_for(
        tbb::blocked_range<size_t>(0, targets.size(), kTargetsAtOnce), [&](const auto& range) {
            for (size_t i = range.begin(); i != range.end(); ++i)
                pixels[targets[i].pixel].add(taken.pixels[targets[i].pixel], firstSample, pass);
        });
}

} // namespace stromboli
