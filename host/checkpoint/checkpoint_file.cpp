#include "host/checkpoint/checkpoint_file.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <new>
#include <string_view>
#include <system_error>

namespace stromboli {

// --- Packed bytes --------------------------------------------------------------------------------

uint32_t checksumOf(std::span<const std::byte> bytes) {
    return uint32_t(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), z_size_t(bytes.size())));
}

void append(std::vector<std::byte>& bytes, const void* data, size_t size) {
    const auto* const first = static_cast<const std::byte*>(data);
    bytes.insert(bytes.end(), first, first + size);
}

void append(std::vector<std::byte>& bytes, const std::string& text) {
    append(bytes, uint64_t(text.size()));
    append(bytes, text.data(), text.size());
}

std::span<const std::byte> ByteParts::take(uint64_t size) {
    if (size > bytes_.size())
        throw UsageError(fmt::format("{}: the {} is cut short", file_->string(), kind_));
    const auto part = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return part;
}

std::string ByteParts::text() {
    const auto part = take(number<uint64_t>());
    return {reinterpret_cast<const char*>(part.data()), part.size()};
}

namespace {

/// The fastest of Zstandard's usual levels. The sums of the kernel are floats in the place of
/// doubles: half of their bytes are zero, which any level finds.
constexpr int kLevel = 1;

} // namespace

std::vector<std::byte> compressed(std::span<const std::byte> bytes) {
    std::vector<std::byte> result(ZSTD_compressBound(bytes.size()));
    const size_t size =
        ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), kLevel);
    if (ZSTD_isError(size)) throw std::bad_alloc(); // the buffer is large enough for all there is
    result.resize(size);
    return result;
}

std::optional<std::vector<std::byte>> decompressed(std::span<const std::byte> bytes,
                                                   uint64_t size) {
    // Before memory is asked for: what is said of the size may be damaged.
    if (ZSTD_getFrameContentSize(bytes.data(), bytes.size()) != size) return std::nullopt;
    std::vector<std::byte> result(size);
    if (ZSTD_decompress(result.data(), result.size(), bytes.data(), bytes.size()) != size)
        return std::nullopt;
    return result;
}

// --- Checkpoints ---------------------------------------------------------------------------------

namespace {

namespace fs = std::filesystem;

/// Changes with every change of what is written around the session's own bytes.
constexpr std::string_view kMagic = "stromboli checkpoint 2\n";

std::vector<std::byte> contentOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream ? std::streamoff(stream.tellg()) : -1;
    std::error_code error;
    if (size < 0 || !fs::is_regular_file(file, error))
        throw UsageError(fmt::format("{}: cannot read the checkpoint", file.string()));
    std::vector<std::byte> bytes(static_cast<size_t>(size));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    if (!stream) throw UsageError(fmt::format("{}: cannot read the checkpoint", file.string()));
    return bytes;
}

} // namespace

fs::path usualCheckpointPath(const fs::path& picture) {
    return picture.string() + ".checkpoint";
}

void writeCheckpoint(const fs::path& file, const Checkpoint& checkpoint) {
    std::vector<std::byte> bytes;
    append(bytes, kMagic.data(), kMagic.size());
    append(bytes, checkpoint.identity.program);
    append(bytes, checkpoint.identity.code);
    append(bytes, checkpoint.identity.scene);
    append(bytes, checkpoint.identity.sceneSum);
    append(bytes, checkpoint.identity.backend);
    append(bytes, checkpoint.identity.device);
    const std::vector<std::byte> state = toBytes(checkpoint.state);
    append(bytes, uint64_t(state.size()));
    const std::vector<std::byte> small = compressed(state);
    append(bytes, small.data(), small.size());
    append(bytes, checksumOf(bytes));
    writeFileAtomically(file, bytes);
}

bool isCheckpoint(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string beginning(kMagic.size(), 0);
    return stream.read(beginning.data(), std::streamsize(beginning.size())) && beginning == kMagic;
}

Checkpoint readCheckpoint(const fs::path& file) {
    const std::vector<std::byte> bytes = contentOf(file);
    ByteParts parts(file, "checkpoint", bytes);
    if (bytes.size() < kMagic.size() ||
        std::memcmp(parts.take(kMagic.size()).data(), kMagic.data(), kMagic.size()) != 0)
        throw UsageError(
            fmt::format("{}: not a checkpoint of this version of the program", file.string()));
    const size_t end = bytes.size() - std::min(bytes.size(), sizeof(uint32_t));
    ByteParts sum(file, "checkpoint", std::span(bytes).subspan(end));
    if (sum.number<uint32_t>() != checksumOf(std::span(bytes).first(end)))
        throw UsageError(fmt::format("{}: the checkpoint is damaged or cut short", file.string()));
    parts = ByteParts(file, "checkpoint", std::span(bytes).first(end).subspan(kMagic.size()));
    Checkpoint c;
    c.identity.program = parts.text();
    c.identity.code = parts.text();
    c.identity.scene = parts.text();
    c.identity.sceneSum = parts.number<uint32_t>();
    c.identity.backend = parts.text();
    c.identity.device = parts.text();
    const auto size = parts.number<uint64_t>();
    const std::optional<std::vector<std::byte>> state = decompressed(parts.rest(), size);
    if (!state) throw UsageError(fmt::format("{}: the checkpoint is damaged", file.string()));
    try {
        c.state = sessionFromBytes(*state);
    } catch (const UsageError& error) {
        throw UsageError(fmt::format("{}: {}", file.string(), error.what()));
    }
    return c;
}

void requireSameRender(const fs::path& file, const Checkpoint& checkpoint,
                       const RenderIdentity& identity, const RenderSettings& settings) {
    const RenderIdentity& kept = checkpoint.identity;
    const auto refuse = [&](const std::string& what, const std::string& advice) {
        throw UsageError(
            fmt::format("{}: the checkpoint is of {}; {}", file.string(), what, advice));
    };
    if (kept.code != identity.code)
        refuse(fmt::format("another build of the program, {}, which takes other samples than {}",
                           kept.program, identity.program),
               "finish it with that one, or begin anew");
    if (kept.backend != identity.backend)
        refuse("the backend " + kept.backend, "name it with --backend");
    const PictureArea &a = checkpoint.state.settings.area, &b = settings.area;
    if (!sameArea(a, b))
        refuse(fmt::format("a picture of {} x {} pixels, {} of them rendered", a.width, a.height,
                           a.pixelCount()),
               "give the same -r and --crop");
    if (kept.sceneSum != identity.sceneSum)
        refuse("another scene or camera" + (kept.scene == identity.scene
                                                ? std::string(": the file has changed")
                                                : " (" + kept.scene + ")"),
               "begin anew");
    if (!sameEstimator(checkpoint.state.settings.estimator, settings.estimator))
        refuse("other settings", "only -s, --noise, --time and -a may change when it goes on");
    const uint32_t block = checkpoint.state.settings.budget.samplesPerBlock;
    if (block != settings.budget.samplesPerBlock)
        refuse(block == 0 ? std::string("a picture that was not begun with --even")
                          : fmt::format("a picture whose samples are added up in blocks of {}",
                                        block * settings.estimator.branches),
               "give the same --even and --block");
}

SessionState withBudget(SessionState state, const Budget& budget) {
    if (!(state.settings.budget == budget)) state.pending.clear();
    state.settings.budget = budget;
    return state;
}

namespace {

struct BandFile {
    fs::path path;
    uint32_t count;
};

/// The number at the front of the text, which is taken off; nothing if there is none.
std::optional<uint32_t> takeNumber(std::string_view& text) {
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return std::nullopt;
    text.remove_prefix(size_t(end - text.data()));
    return number;
}

/// The count in "2of5".
std::optional<uint32_t> countIn(std::string_view text) {
    const std::optional<uint32_t> band = takeNumber(text);
    if (!band || !text.starts_with("of")) return std::nullopt;
    text.remove_prefix(2);
    const std::optional<uint32_t> count = takeNumber(text);
    if (!count || !text.empty() || *band < 1 || *band > *count) return std::nullopt;
    return count;
}

std::vector<BandFile> bandFilesOf(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const std::string beginning = file.filename().string() + ".band";
    std::vector<BandFile> found;
    std::error_code error; // a folder that cannot be listed has none
    for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
        const std::string name = i->path().filename().string();
        if (!name.starts_with(beginning)) continue;
        if (const auto count = countIn(std::string_view(name).substr(beginning.size())))
            found.push_back({i->path(), *count});
    }
    return found;
}

} // namespace

fs::path bandFile(const fs::path& file, size_t band, size_t count) {
    return file.string() + fmt::format(".band{}of{}", band + 1, count);
}

uint32_t bandsKept(const fs::path& file) {
    const std::vector<BandFile> files = bandFilesOf(file);
    for (const BandFile& f : files)
        if (f.count != files.front().count)
            throw UsageError(
                fmt::format("there are checkpoints of {} and of {} bands beside {}, of "
                            "two renders: remove those of the older one",
                            files.front().count, f.count, file.string()));
    return files.empty() ? 0 : files.front().count;
}

void removeBandFiles(const fs::path& file) {
    std::error_code failed;
    for (const BandFile& f : bandFilesOf(file))
        fs::remove(f.path, failed);
}

} // namespace stromboli
