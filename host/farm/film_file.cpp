// A film: kFilmMagic, the size and checksum of the header, the header; then each run of pixels: its
// size, its checksum, and its numbers, compressed, and the same of its layers, if it holds them;
// then kFilmEnd.
#include "host/farm/film_file.hpp"

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/error.hpp"
#include "host/farm/film_marks.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
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

namespace {

namespace fs = std::filesystem;

/// Rows become columns.
std::vector<float> transposed(std::span<const float> values, size_t rows, size_t columns) {
    std::vector<float> result(values.size());
    for (size_t row = 0; row < rows; ++row)
        for (size_t column = 0; column < columns; ++column)
            result[column * rows + row] = values[row * columns + column];
    return result;
}

/// Size and checksum, then the bytes.
void writePart(TemporaryFile& file, std::span<const std::byte> bytes) {
    std::vector<std::byte> front;
    append(front, uint64_t(bytes.size()));
    append(front, checksumOf(bytes));
    file.write(front);
    file.write(bytes);
}
constexpr uint64_t kFront = sizeof(uint64_t) + sizeof(uint32_t);

uint64_t pixelsOf(const FilmHeader& header) {
    return header.isEmpty() ? 0 : header.settings.area.pixelCount();
}

size_t pixelsPerRun(const PictureArea& area) {
    return size_t(rowsPerRun(area)) * area.rendered().width;
}

} // namespace

bool namesFilm(const fs::path& path) {
    return path.extension() == ".film";
}

FilmWriter::FilmWriter(const fs::path& path, const FilmHeader& header)
    : file_(path), pixelsPerRun_(pixelsPerRun(header.settings.area)), pixelsLeft_(pixelsOf(header)),
      channels_(header.layerChannels()) {
    file_.write(std::as_bytes(std::span(kFilmMagic)));
    writePart(file_, toBytes(header));
}

void FilmWriter::add(std::span<const SharedPixel> pixels, std::span<const float> layers) {
    if (pixels.size() > pixelsLeft_ - run_.size())
        throw std::logic_error("more pixels than the film has");
    if (layers.size() != pixels.size() * channels_)
        throw std::logic_error("pixels have more or fewer layers than the film");
    while (!pixels.empty()) {
        const size_t count = std::min(pixels.size(), pixelsPerRun_ - run_.size());
        run_.insert(run_.end(), pixels.begin(), pixels.begin() + std::ptrdiff_t(count));
        pixels = pixels.subspan(count);
        const auto ofThese = layers.first(count * channels_);
        layers_.insert(layers_.end(), ofThese.begin(), ofThese.end());
        layers = layers.subspan(ofThese.size());
        if (run_.size() == pixelsPerRun_ || run_.size() == pixelsLeft_) writeRun();
    }
}

void FilmWriter::writeRun() {
    writePart(file_, toBytes(run_));
    if (channels_ > 0) {
        const std::vector<float> byChannel = transposed(layers_, run_.size(), channels_);
        writePart(file_, compressed(std::as_bytes(std::span(byChannel))));
    }
    pixelsLeft_ -= run_.size();
    run_.clear();
    layers_.clear();
}

void FilmWriter::finish() {
    if (pixelsLeft_ > 0) throw std::logic_error("the film lacks pixels");
    file_.write(std::as_bytes(std::span(kFilmEnd)));
    file_.rename(Sync::Now);
}

FilmReader::FilmReader(const fs::path& path) : FilmReader(path, End::Wanted) {}

FilmReader::FilmReader(const fs::path& path, End wanted) : path_(path) {
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat status = {};
    if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
        const int error = errno;
        if (descriptor_ >= 0) ::close(descriptor_);
        refuse("cannot read the film: " + std::generic_category().message(error));
    }
    size_ = uint64_t(status.st_size);
    try {
        if (!S_ISREG(status.st_mode)) refuse("it is no film");
        if (size_ < kFilmMagic.size() ||
            std::memcmp(read(kFilmMagic.size()).data(), kFilmMagic.data(), kFilmMagic.size()) != 0)
            refuse("not a film of this version of the program");
        char end[kFilmEnd.size()] = {};
        const auto place = off_t(size_ - std::min<uint64_t>(size_, kFilmEnd.size()));
        if (wanted == End::Wanted &&
            (::pread(descriptor_, end, sizeof end, place) != ssize_t(sizeof end) ||
             std::string_view(end, sizeof end) != kFilmEnd))
            refuse("the film is cut short");
        const std::vector<std::byte> bytes = readPart();
        header_ = filmHeaderFromBytes(bytes, path_);
    } catch (...) {
        ::close(descriptor_);
        throw;
    }
    pixelsPerRun_ = pixelsPerRun(header_.settings.area);
    pixelsLeft_ = header_.settings.area.pixelCount();
}

FilmReader::FilmReader(FilmReader&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_), position_(other.position_), header_(std::move(other.header_)),
      pixelsPerRun_(other.pixelsPerRun_), pixelsLeft_(other.pixelsLeft_) {}

FilmReader::~FilmReader() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

void FilmReader::refuse(const std::string& why) const {
    throw UsageError(fmt::format("{}: {}", path_.string(), why));
}

std::vector<std::byte> FilmReader::read(uint64_t size) {
    if (size > size_ - position_) refuse("the film is damaged or cut short");
    std::vector<std::byte> bytes(size);
    for (uint64_t done = 0; done < size;) {
        const ssize_t n =
            ::pread(descriptor_, bytes.data() + done, size - done, off_t(position_ + done));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) refuse("cannot read the film: " + std::generic_category().message(errno));
        done += uint64_t(n);
    }
    position_ += size;
    return bytes;
}

PackedRun FilmReader::next() {
    const auto pixels = size_t(std::min<uint64_t>(pixelsPerRun_, pixelsLeft_));
    pixelsLeft_ -= pixels;
    if (header_.isEmpty()) return PackedRun(pixels);
    std::optional<PackedRun> run = PackedRun::fromBytes(readPart(), pixels);
    if (!run) refuse("the film is damaged");
    return std::move(*run);
}

void FilmReader::nextLayers(std::vector<float>& layers) {
    const size_t channels = header_.layerChannels();
    layers.clear();
    if (channels == 0) return;
    const uint64_t done = header_.settings.area.pixelCount() - pixelsLeft_;
    const size_t pixels = (done - 1) % pixelsPerRun_ + 1;
    const auto bytes = decompressed(readPart(), pixels * channels * sizeof(float));
    if (!bytes) refuse("the film is damaged");
    std::vector<float> byChannel(pixels * channels);
    std::memcpy(byChannel.data(), bytes->data(), bytes->size());
    layers = transposed(byChannel, channels, pixels);
}

std::vector<std::byte> FilmReader::readPart() {
    const std::vector<std::byte> front = read(kFront);
    ByteParts parts(path_, "film", front);
    const auto size = parts.number<uint64_t>();
    const auto sum = parts.number<uint32_t>();
    std::vector<std::byte> bytes = read(size);
    if (checksumOf(bytes) != sum) refuse("the film is damaged");
    return bytes;
}

} // namespace stromboli
