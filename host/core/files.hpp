#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace stromboli {

// --- Files that are whole or not there -----------------------------------------------------------

/// When the bytes of a file are on the disk, and not only in the system's memory.
enum class Sync {
    Now,  ///< before the file gets its name: no full disk is found out later, no power cut hurts
    Later ///< whenever the system likes: for files that are checked when they are read
};

/// Writes `bytes` to `path` so that at every moment the file there is the old one (or none) or
/// the complete new one: the bytes go to a new file beside it, which then takes its name. A
/// symbolic link at `path` is followed. Throws OutputError, naming the file and the reason;
/// nothing new is left behind then.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes,
                         Sync sync = Sync::Now);

/// Throws the OutputError that writeFileAtomically(path, ...) would throw, as far as that can be
/// known beforehand: it makes and removes an empty file beside `path`.
void checkFileWritable(const std::filesystem::path& path);

/// Throws OutputError if the file system that `path` is on has not so many bytes free.
void checkFreeSpace(const std::filesystem::path& path, uint64_t bytes);

// --- Temporary files -----------------------------------------------------------------------------

/// A new file in the folder of `path`, locked (flock) for as long as it is one, and removed again
/// unless it takes the name of `path`. Files that killed processes have left beside `path` are
/// removed when a new one is made: those that nobody holds the lock of. Throws OutputError.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& path);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::span<const std::byte> bytes);
    /// Takes the name of `path`, in place of a file that is there.
    void rename(Sync sync);

    const std::filesystem::path& name() const { return temporary_; }

  private:
    std::filesystem::path path_, temporary_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

/// Removes all temporary files of this process and keeps every thread from making another one, or
/// giving one its name: for a process that ends now, whatever its threads are doing.
void removeTemporaryFilesForGood();

/// Throws the OutputError that `path` cannot be written, for this reason.
[[noreturn]] void failToWrite(const std::filesystem::path& path, const std::string& reason);
/// Throws that OutputError with the system's text for an error number (errno).
[[noreturn]] void failToWrite(const std::filesystem::path& path, int error);

/// The folder that a file of this name is in.
std::filesystem::path folderOf(const std::filesystem::path& path);

// --- Checksums -----------------------------------------------------------------------------------

/// CRC-32 of a file's bytes; of no bytes if it cannot be read.
uint32_t checksumOfFile(const std::filesystem::path& file);

// --- Standard output -----------------------------------------------------------------------------

/// Where a command writes: a file, or standard output where the name is "-".
bool isStandardOutput(const std::filesystem::path& path);

/// Writes a file as writeFileAtomically() does, or all bytes to standard output. Throws
/// OutputError.
void writeOutput(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeOutput(const std::filesystem::path& path, std::string_view text);

/// Checks what checkFileWritable() does; of standard output nothing is known beforehand.
void checkOutputWritable(const std::filesystem::path& path);

/// To be called before anything is opened: a standard stream that was closed when the program was
/// started would give its number to the next file that is opened, and what is printed would end up
/// there. Writing to a closed standard output fails.
void reserveStandardStreams();

/// Throws OutputError if something that was printed could not be written. To be called at the end:
/// what is printed waits in a buffer.
void finishStandardOutput();

} // namespace stromboli
