#include "host/render/sampling_session.hpp"

#include "host/core/error.hpp"

#include <zlib.h>

#include <algorithm>
#include <concepts>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

namespace stromboli {

// --- The state of a render -----------------------------------------------------------------------

namespace {

/// Changes with every change of what is written.
constexpr std::string_view kVersion = "stromboli session 14";

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::same_as<T, glm::dvec3>;

/// Appends the values it is given to a row of bytes.
struct Writer {
    std::vector<std::byte> bytes;

    template <Plain T>
    void operator()(T& value) {
        const auto* const first = reinterpret_cast<const std::byte*>(&value);
        bytes.insert(bytes.end(), first, first + sizeof value);
    }
    template <class T>
    void resize(std::vector<T>& list) {
        uint64_t size = list.size();
        (*this)(size);
    }
    void bytesOf(std::vector<std::byte>& list) {
        resize(list);
        bytes.insert(bytes.end(), list.begin(), list.end());
    }
};

/// Takes the values from a row of bytes.
struct Reader {
    std::span<const std::byte> bytes;

    template <Plain T>
    void operator()(T& value) {
        if (bytes.size() < sizeof value) throw UsageError("the saved render is cut short");
        std::memcpy(&value, bytes.data(), sizeof value);
        bytes = bytes.subspan(sizeof value);
    }
    template <class T>
    void resize(std::vector<T>& list) {
        uint64_t size = 0;
        (*this)(size);
        if (size > bytes.size()) throw UsageError("the saved render is cut short"); // a byte each
        list.resize(size);
    }
    void bytesOf(std::vector<std::byte>& list) {
        resize(list);
        std::ranges::copy(bytes.first(list.size()), list.begin());
        bytes = bytes.subspan(list.size());
    }
};

// One function for each structure serves both directions. Member by member: padding means nothing.

template <class Archive>
void pass(Archive& a, Crop& c) {
    a(c.x), a(c.y), a(c.width), a(c.height);
}

template <class Archive>
void pass(Archive& a, ShadingConventions& conventions) {
    // Names all members: one more is an error here.
    auto& [forward, offset, side, fresnel, lambda, compresses, find, square, ambient, emitters,
           every, hemisphere] = conventions;
    a(forward), a(side), a(fresnel), a(lambda), a(compresses), a(find), a(square), a(ambient);
    a(emitters), a(every), a(hemisphere), a(offset);
}

template <class Archive>
void pass(Archive& a, FilterShape& shape) {
    auto& [width, b, c, lobes] = shape;
    a(width), a(b), a(c), a(lobes);
}

template <class Archive>
void pass(Archive& a, Estimator& e) {
    a(e.lightSamples), a(e.maxBounces), a(e.minBounce), a(e.integrator), a(e.directLight);
    a(e.sampler), a(e.filter), a(e.lightChoice), a(e.branches), a(e.gapProposal), a(e.guidesLight),
        a(e.aimsAtPortals), a(e.roulette.mode);
    a(e.roulette.terminationProbability), a(e.roulette.throughputStart), a(e.seed),
        a(e.showsBackdrop), a(e.indirectLimit);
    pass(a, e.filterShape);
    pass(a, e.conventions);
}

template <class Archive>
void pass(Archive& a, Budget& b) {
    a(b.mostSamplesPerPixel), a(b.meanSamplesPerPixel);
    a(b.adaptive.enabled), a(b.adaptive.rule), a(b.adaptive.batch), a(b.adaptive.tolerance);
    a(b.stop.noise), a(b.stop.seconds);
    a(b.samplesPerBlock);
}

template <class Archive>
void pass(Archive& a, KeptPixels& p) {
    a(p.as), a(p.strands);
    a.bytesOf(p.bytes);
}

template <class Archive>
void pass(Archive& a, ExactStatistics& s) {
    a(s.count), a(s.rejected), a(s.firstRejected);
    for (ExactStatistics::Sum& sum : s.sum)
        for (uint64_t& word : sum.words)
            a(word);
    for (ExactStatistics::Squares& squares : s.squares)
        for (uint64_t& word : squares.words)
            a(word);
}

template <class Archive>
void pass(Archive& a, PixelTarget& t) {
    a(t.pixel), a(t.samples);
}

template <class Archive, Plain T>
void pass(Archive& a, T& value) {
    a(value);
}

template <class Archive, class T>
void passList(Archive& a, std::vector<T>& list) {
    a.resize(list);
    for (T& item : list)
        pass(a, item);
}

template <class Archive>
void pass(Archive& a, SessionState& s) {
    a(s.settings.area.width), a(s.settings.area.height);
    pass(a, s.settings.area.crop);
    pass(a, s.settings.estimator);
    pass(a, s.settings.budget);
    pass(a, s.pixels);
    passList(a, s.blocks);
    passList(a, s.estimate.counts);
    passList(a, s.estimate.means);
    passList(a, s.estimate.squaredErrors);
    passList(a, s.pending);
    a(s.secondsUsed);
}

uint32_t checksum(std::span<const std::byte> bytes) {
    return uint32_t(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), z_size_t(bytes.size())));
}

} // namespace

bool sameEstimator(const Estimator& a, const Estimator& b) {
    const auto bytesOf = [](Estimator estimator) {
        Writer writer;
        pass(writer, estimator);
        return std::move(writer.bytes);
    };
    return bytesOf(a) == bytesOf(b);
}

std::vector<std::byte> toBytes(const SessionState& state) {
    Writer writer;
    for (char c : kVersion)
        writer(c);
    SessionState copy = state; // both directions share the code that takes members by reference
    pass(writer, copy);
    uint32_t sum = checksum(writer.bytes);
    writer(sum);
    return std::move(writer.bytes);
}

SessionState sessionFromBytes(std::span<const std::byte> bytes) {
    if (bytes.size() < kVersion.size() + sizeof(uint32_t) ||
        std::memcmp(bytes.data(), kVersion.data(), kVersion.size()) != 0)
        throw UsageError("the saved render is none of this version of the program");
    Reader end{bytes.last(sizeof(uint32_t))};
    uint32_t sum = 0;
    end(sum);
    const std::span<const std::byte> checked = bytes.first(bytes.size() - sizeof sum);
    if (checksum(checked) != sum) throw UsageError("the saved render is damaged");
    Reader reader{checked.subspan(kVersion.size())};
    SessionState state;
    pass(reader, state);
    if (!reader.bytes.empty()) throw UsageError("the saved render is longer than expected");
    if (!state.pixels.isWhole()) throw UsageError("the saved render has pixels of no known kind");
    return state;
}

// --- Sessions ------------------------------------------------------------------------------------

SamplingSession::SamplingSession(Backend& backend, const RenderSettings& settings)
    : backend_(backend), settings_(settings), plan_(settings.budget),
      noisePlan_(settings.budget.mostSamplesPerPixel, settings.estimator.branches,
                 settings.budget.stop.seconds > 0 ? NoisePlan::Beginning::CoarseToFine
                                                  : NoisePlan::Beginning::AllAlike),
      film_(settings.area) {
    film_.branches = settings.estimator.branches;
}

SamplingSession::SamplingSession(Backend& backend, const SessionState& saved)
    : SamplingSession(backend, saved.settings) {
    backend_.restoreBlocks(saved.blocks);
    backend_.restoreAll(saved.pixels, film_);
    estimate_.remember(saved.estimate);
    pending_ = saved.pending;
    secondsBefore_ = saved.secondsUsed;
    countSamples();
}

void SamplingSession::countSamples() {
    samplesDone_ = 0;
    for (const PixelStatistics& p : film_.pixels)
        samplesDone_ += p.taken();
}

bool SamplingSession::pass(const ProgressCallback& progress) {
    if (!watch_) watch_.emplace();
    if (timeIsUp()) return false;
    if (pending_.empty()) pending_ = nextPass();
    if (pending_.empty()) return false;
    bool goesOn = true;
    sample(progress, goesOn);
    if (isComplete(pending_)) {
        // One sample tells no error; two do, without what was before them.
        if (pending_.front().samples > 1) estimate_.update(film_);
        pending_.clear();
    } else {
        countSamples(); // a backend that is stopped may end some more than it has told of
    }
    return goesOn && !timeIsUp();
}

std::vector<PixelTarget> SamplingSession::nextPass() const {
    const Budget& budget = settings_.budget;
    if (!budget.spreads()) return plan_.next(film_);
    return noisePlan_.next(film_, estimate_, samplesLeft(), budget.stop.noise);
}

void SamplingSession::sample(const ProgressCallback& progress, bool& goesOn) {
    RenderProgress state;
    state.samplesAtMost = samplesAtMost(settings_.area, settings_.budget);
    const uint64_t before = samplesDone_, expected = expectedSamples();
    const double seconds = settings_.budget.stop.seconds;
    backend_.sample(pending_, film_, [&](uint64_t done) {
        samplesDone_ = before + done;
        state.samplesDone = samplesDone_;
        state.counters = backend_.counters();
        state.share = std::max(seconds > 0 ? secondsUsed() / seconds : 0,
                               double(samplesDone_) / double(expected));
        if (progress && goesOn) goesOn = progress(state);
        return goesOn && !timeIsUp();
    });
}

bool SamplingSession::isComplete(const std::vector<PixelTarget>& pass) const {
    return std::all_of(pass.begin(), pass.end(), [&](const PixelTarget& t) {
        return film_.pixels[t.pixel].taken() >= t.samples;
    });
}

bool SamplingSession::timeIsUp() const {
    const double seconds = settings_.budget.stop.seconds;
    return seconds > 0 && secondsUsed() >= seconds;
}

/// Samples that the budget still has, as to time at the rate so far, or one a pixel while there is
/// none.
uint64_t SamplingSession::samplesLeft() const {
    const Budget& budget = settings_.budget;
    const uint64_t all = budget.meanSamplesPerPixel > 0
                             ? film_.pixels.size() * uint64_t(budget.meanSamplesPerPixel)
                             : std::numeric_limits<uint64_t>::max();
    const uint64_t left = all - std::min(samplesDone_, all);
    if (budget.stop.seconds == 0) return left;
    const double used = secondsUsed();
    if (samplesDone_ == 0 || used == 0) return std::min(left, uint64_t(film_.pixels.size()));
    const double remaining = std::max(budget.stop.seconds - used, 0.0);
    return std::min(left, uint64_t(remaining * double(samplesDone_) / used));
}

/// In all: if the noise is to fall from where it is now to the one asked for, as 1 / sqrt(n).
uint64_t SamplingSession::expectedSamples() const {
    const uint64_t atMost = samplesAtMost(settings_.area, settings_.budget);
    const double target = settings_.budget.stop.noise;
    if (target == 0 || samplesDone_ == 0) return atMost;
    const PictureNoise reached = estimate_.picture(film_);
    if (!reached.known() || reached.most <= target) return atMost;
    const double ratio = reached.most / target;
    const double expected = double(samplesDone_) * ratio * ratio;
    return expected < double(atMost) ? uint64_t(expected) + 1 : atMost;
}

NoiseEstimate SamplingSession::estimateNow() const {
    NoiseEstimate now = estimate_;
    if (!pending_.empty()) now.update(film_); // the pass that was stopped has changed some pixels
    return now;
}

RenderOutcome SamplingSession::outcome() const {
    if (pending_.empty()) return {estimate_.picture(film_), timeIsUp()};
    return {estimateNow().picture(film_), timeIsUp()};
}

std::vector<glm::dvec3> SamplingSession::squaredErrors() const {
    std::vector<glm::dvec3> errors = estimateNow().memory().squaredErrors;
    errors.resize(film_.pixels.size(), glm::dvec3(0.0)); // none: not one pass is complete
    return errors;
}

SessionState SamplingSession::save() const {
    return {
        settings_,    backend_.saveAll(film_), backend_.saveBlocks(), estimate_.memory(), pending_,
        secondsUsed()};
}

// --- Renders in one go ---------------------------------------------------------------------------

uint64_t samplesAtMost(const PictureArea& area, const Budget& budget) {
    const uint32_t mean = budget.meanSamplesPerPixel, most = budget.mostSamplesPerPixel;
    return area.pixelCount() * (mean > 0 ? std::min(mean, most) : most);
}

Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress,
            RenderOutcome* outcome) {
    SamplingSession session(backend, settings);
    while (session.pass(progress)) {
    }
    if (outcome) *outcome = session.outcome();
    return std::move(session).takeFilm();
}

} // namespace stromboli
