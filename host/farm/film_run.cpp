#include "host/farm/film_run.hpp"

#include "host/checkpoint/byte_parts.hpp"
#include "host/checkpoint/compression.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <utility>

namespace stromboli {
namespace {

/// A set of kinds.
using Kinds = uint64_t;
/// Not a kind: all samples of every pixel are of its last pass, of which nothing is said beside its
/// number. So it is in the film of a share, mostly.
constexpr Kinds kOfOnePass = Kinds(1) << 63;

/// Calls visit(kind, numberOf) for all kinds of numbers that a pixel has: those of all samples,
/// then, from kLastKinds on, those of the last pass.
template <class Visit>
void forEachKind(const Visit& visit) {
    uint32_t kind = 0;
    visit(
        kind++, [](auto& p) -> auto& { return p.all.count; });
    visit(
        kind++, [](auto& p) -> auto& { return p.all.rejected; });
    visit(
        kind++, [](auto& p) -> auto& { return p.all.firstRejected; });
    visit(
        kind++, [](auto& p) -> auto& { return p.covered; });
    visit(
        kind++, [](auto& p) -> auto& { return p.lastPass; });
    for (size_t c = 0; c < 3; ++c) {
        for (size_t i = 0; i < ExactStatistics().sum[c].words.size(); ++i)
            visit(
                kind++, [=](auto& p) -> auto& { return p.all.sum[c].words[i]; });
        for (size_t i = 0; i < ExactStatistics().squares[c].words.size(); ++i)
            visit(
                kind++, [=](auto& p) -> auto& { return p.all.squares[c].words[i]; });
    }
    visit(
        kind++, [](auto& p) -> auto& { return p.lastCount; });
    for (size_t c = 0; c < 3; ++c)
        for (size_t i = 0; i < SharedPixel().lastSum[c].words.size(); ++i)
            visit(
                kind++, [=](auto& p) -> auto& { return p.lastSum[c].words[i]; });
}
constexpr uint32_t kLastKinds = 5 + 3 * (4 + 5);
constexpr uint32_t kKinds = kLastKinds + 1 + 3 * 4;
static_assert(kKinds < 63);

template <class NumberOf>
constexpr size_t sizeOf = sizeof(std::declval<NumberOf>()(std::declval<SharedPixel&>()));

/// Pixels that are turned from rows of pixels to rows of numbers, or back, at a time: 64 KiB of
/// sums stay in a core's own cache for all of their numbers.
constexpr size_t kTile = 256;

/// Calls visit(numberOf, pixel, place) for all numbers of these kinds of `count` pixels and their
/// place in the run's bytes, where numbers of a kind are side by side: neighbouring pixels have
/// nearly the same high digits, and counts are all alike.
template <class Visit>
void forEachPlace(size_t count, Kinds kinds, const Visit& visit) {
    for (size_t tile = 0; tile < count; tile += kTile) {
        size_t row = 0; // the place of the numbers of a kind
        const size_t end = std::min(tile + kTile, count);
        forEachKind([&](uint32_t kind, const auto& numberOf) {
            if ((kinds >> kind & 1) == 0) return;
            constexpr size_t size = sizeOf<decltype(numberOf)>;
            for (size_t i = tile; i < end; ++i)
                visit(numberOf, i, row + i * size);
            row += count * size;
        });
    }
}

/// Those that are not 0 everywhere, which is more than half: sums have room for any picture.
Kinds kindsIn(std::span<const SharedPixel> run) {
    Kinds kinds = 0;
    for (const SharedPixel& p : run)
        forEachKind(
            [&](uint32_t kind, const auto& numberOf) { kinds |= Kinds(numberOf(p) != 0) << kind; });
    if (std::ranges::all_of(run, &SharedPixel::isOfOnePass))
        kinds = (kinds & ((Kinds(1) << kLastKinds) - 1)) | kOfOnePass;
    return kinds;
}

size_t bytesOf(Kinds kinds) {
    size_t bytes = 0;
    forEachKind([&](uint32_t kind, const auto& numberOf) {
        if (kinds >> kind & 1) bytes += sizeOf<decltype(numberOf)>;
    });
    return bytes;
}

/// Where the numbers of each kind begin, and how far apart those of neighbours are: kinds that are
/// 0 everywhere have but one of them.
class Columns {
  public:
    Columns(Kinds kinds, std::span<const std::byte> numbers, size_t pixels) {
        static constexpr uint64_t kZero = 0;
        const std::byte* next = numbers.data();
        forEachKind([&](uint32_t kind, const auto& numberOf) {
            columns_[kind] = {reinterpret_cast<const std::byte*>(&kZero), 0};
            if ((kinds >> kind & 1) == 0) return;
            constexpr size_t size = sizeOf<decltype(numberOf)>;
            columns_[kind] = {next, size};
            next += pixels * size;
        });
    }
    /// The first `count` kinds of numbers of a pixel.
    template <uint32_t count>
    void read(size_t i, SharedPixel& pixel) const {
        forEachKind([&](uint32_t kind, const auto& numberOf) {
            if (kind >= count) return;
            auto& number = numberOf(pixel);
            std::memcpy(&number, columns_[kind].first + i * columns_[kind].distance, sizeof number);
        });
    }

  private:
    struct Column {
        const std::byte* first;
        size_t distance;
    };
    std::array<Column, kKinds> columns_;
};

} // namespace

std::vector<std::byte> toBytes(std::span<const SharedPixel> run) {
    const Kinds kinds = kindsIn(run);
    std::vector<std::byte> numbers(run.size() * bytesOf(kinds));
    forEachPlace(run.size(), kinds, [&](const auto& numberOf, size_t i, size_t place) {
        const auto number = numberOf(run[i]);
        std::memcpy(numbers.data() + place, &number, sizeof number);
    });
    std::vector<std::byte> bytes;
    append(bytes, kinds);
    const std::vector<std::byte> small = compressed(numbers);
    append(bytes, small.data(), small.size());
    return bytes;
}

std::optional<PackedRun> PackedRun::fromBytes(std::span<const std::byte> bytes, size_t pixels) {
    PackedRun run(pixels);
    if (bytes.size() < sizeof run.kinds_) return std::nullopt;
    std::memcpy(&run.kinds_, bytes.data(), sizeof run.kinds_);
    auto numbers = decompressed(bytes.subspan(sizeof run.kinds_), pixels * bytesOf(run.kinds_));
    if (!numbers) return std::nullopt;
    run.numbers_ = std::move(*numbers);
    return run;
}

void PackedRun::addTo(std::span<SharedPixel> sums, size_t first) const {
    if (kinds_ == 0) return;
    const Columns columns(kinds_, numbers_, pixels_);
    SharedPixel pixel; // whose numbers are those of one pixel after the other
    const bool isOfOnePass = (kinds_ & kOfOnePass) != 0;
    for (size_t i = 0; i < sums.size(); ++i) {
        if (isOfOnePass)
            columns.read<kLastKinds>(first + i, pixel);
        else
            columns.read<kKinds>(first + i, pixel);
        if (pixel.all.taken() == 0) continue; // a planned share has few pixels
        if (isOfOnePass)
            sums[i].addOfOnePass(pixel);
        else
            sums[i].add(pixel);
    }
}

} // namespace stromboli
