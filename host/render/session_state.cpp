#include "host/render/session_state.hpp"

#include "host/core/error.hpp"

#include <zlib.h>

#include <concepts>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace stromboli {
namespace {

/// Changes with every change of what is written.
constexpr std::string_view kVersion = "stromboli session 7";

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
    a(e.sampler), a(e.filter), a(e.lightChoice), a(e.branches), a(e.gapProposal),
        a(e.roulette.mode);
    a(e.roulette.terminationProbability), a(e.roulette.throughputStart), a(e.seed),
        a(e.showsBackdrop);
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
void pass(Archive& a, PixelSums& s) {
    a(s.count), a(s.rejected), a(s.firstRejected);
    a(s.first), a(s.firstError), a(s.second), a(s.secondError);
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
    passList(a, s.sums);
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
    return state;
}

} // namespace stromboli
