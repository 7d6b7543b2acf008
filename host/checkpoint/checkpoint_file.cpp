#include "host/checkpoint/checkpoint_file.hpp"

#include "host/checkpoint/byte_parts.hpp"
#include "host/checkpoint/compression.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>

namespace stromboli {
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

} // namespace stromboli
