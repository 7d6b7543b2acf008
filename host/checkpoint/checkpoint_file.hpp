#pragma once

#include "host/render/sampling_session.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stromboli {

// --- Packed bytes --------------------------------------------------------------------------------

/// CRC-32.
uint32_t checksumOf(std::span<const std::byte> bytes);

// What files of saved renders are made of, in this machine's byte order.

void append(std::vector<std::byte>& bytes, const void* data, size_t size);
/// Its length, then its bytes.
void append(std::vector<std::byte>& bytes, const std::string& text);
template <class T>
requires std::is_arithmetic_v<T>
void append(std::vector<std::byte>& bytes, T value) {
    append(bytes, &value, sizeof value);
}

/// Takes parts of a file from its beginning. Throws UsageError that names the file, and what it is
/// ("checkpoint"), if it has no more.
class ByteParts {
  public:
    ByteParts(const std::filesystem::path& file, std::string kind, std::span<const std::byte> bytes)
        : file_(&file), kind_(std::move(kind)), bytes_(bytes) {}

    std::span<const std::byte> take(uint64_t size);
    template <class T>
    T number() {
        T value{};
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string text();
    std::span<const std::byte> rest() const { return bytes_; }

  private:
    const std::filesystem::path* file_;
    std::string kind_;
    std::span<const std::byte> bytes_;
};

/// Fewer bytes that say the same, made at some hundred megabytes a second.
std::vector<std::byte> compressed(std::span<const std::byte> bytes);

/// The `size` bytes that were compressed; nothing if they were others or another number.
std::optional<std::vector<std::byte>> decompressed(std::span<const std::byte> bytes, uint64_t size);

// --- Checkpoints ---------------------------------------------------------------------------------

/// What a render is of: a checkpoint of it goes on with nothing else.
struct RenderIdentity {
    std::string program;   ///< its version, for messages
    std::string code;      ///< renderingCode()
    std::string scene;     ///< its name, for messages
    uint32_t sceneSum = 0; ///< sceneIdentity()
    std::string backend;   ///< of a kind: kinds keep a pixel's sums in terms of their own
    std::string device;    ///< whose rounding the samples have
};

/// A render's state as a file keeps it.
struct Checkpoint {
    RenderIdentity identity;
    SessionState state;
};

/// Where a render keeps its state unless it is told otherwise: beside its picture.
std::filesystem::path usualCheckpointPath(const std::filesystem::path& picture);

/// Replaces the file whole. Throws OutputError.
void writeCheckpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// Whether the file begins as one of this version does.
bool isCheckpoint(const std::filesystem::path& file);
/// Throws UsageError that names the file if it is none, damaged, cut short or of another version.
Checkpoint readCheckpoint(const std::filesystem::path& file);

/// Throws UsageError that says what differs, unless a render of this identity and these settings
/// may go on from the checkpoint: all but the budget and the name of the scene's file are the same.
/// (Another device is left to the caller: pictures agree, bytes do not.)
void requireSameRender(const std::filesystem::path& file, const Checkpoint& checkpoint,
                       const RenderIdentity& identity, const RenderSettings& settings);

/// The state to go on from with a budget that may be another. The pass that was under way belongs
/// to the budget it was planned for: with another one it is planned anew.
SessionState withBudget(SessionState state, const Budget& budget);

// A picture that is rendered in bands has a checkpoint for each, beside where that of the whole
// picture would be. Bands have about the same height (host/render/block_backend.hpp), so that their
// number says which rows each has.

/// FILE.band2of5 for the second one of five; `band` counts from 0.
std::filesystem::path bandFile(const std::filesystem::path& file, size_t band, size_t count);

/// The number of bands that the checkpoints beside the file are of; 0: there are none. Throws
/// UsageError if they are of different numbers: of two renders.
uint32_t bandsKept(const std::filesystem::path& file);

/// Removes the checkpoints of all bands, of however many. What cannot be removed stays.
void removeBandFiles(const std::filesystem::path& file);

} // namespace stromboli
