// One program for each format: libFuzzer gives it mutated files, which the loader may refuse with a
// SceneError and with nothing else. tests/fuzz/run builds and runs them.
#include "host/core/error.hpp"
#include "scene/build/read_file.hpp"
#include "scene/collada/load_collada.hpp"
#include "scene/gltf/load_gltf.hpp"
#include "scene/images/picture.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"
#include "scene/mitsuba/volumes.hpp"
#include "scene/obj/load_obj.hpp"
#include "scene/pbrt/load_pbrt.hpp"
#include "scene/pbrt/nanovdb.hpp"
#include "scene/ply/load_ply.hpp"

#include <sys/mman.h>
#include <unistd.h>
#include <zlib.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

namespace {

using namespace stromboli;

/// A file in memory, by a name that loaders can open.
class MemoryFile {
  public:
    MemoryFile() : descriptor_(memfd_create("fuzz", 0)) {
        if (descriptor_ < 0) std::abort();
    }
    std::filesystem::path hold(const uint8_t* data, size_t size) {
        if (ftruncate(descriptor_, off_t(size)) != 0) std::abort();
        if (pwrite(descriptor_, data, size, 0) != ssize_t(size)) std::abort();
        return "/proc/self/fd/" + std::to_string(descriptor_);
    }

  private:
    int descriptor_;
};

#if defined(FUZZ_LOAD)
/// Large pictures would take nearly all of the time, and find nothing that small ones do not.
SceneConventions conventions() {
    SceneConventions result;
    result.selection.largestTexture = 16;
    return result;
}
#endif

#if defined(FUZZ_NANOVDB)
/// A small grid that is not packed: packed ones that are changed are hardly ever ones of zlib's.
std::string unpackedGrid() {
    const std::string file = build::readFile(STROMBOLI_SOURCE_DIR "/tests/scene/pbrt/cube.nvdb");
    constexpr size_t kGrid =
        16 + 2 * 176 + sizeof "density" + sizeof "temperature"; // behind the headers
    uLongf size = 0;
    std::memcpy(&size, file.data() + 16, sizeof size);
    std::string grid(size, '\0');
    if (uncompress(reinterpret_cast<Bytef*>(grid.data()), &size,
                   reinterpret_cast<const Bytef*>(file.data() + kGrid + 8),
                   uLong(file.size() - kGrid - 8)) != Z_OK)
        std::abort();
    grid[7] = '1'; // a grid alone
    return grid;
}

/// The input says which bytes become what: four bytes of place and one of value, again and again.
void readChangedGrid(const uint8_t* data, size_t size) {
    static const std::string original = unpackedGrid();
    std::string grid = original;
    for (; size >= 5; data += 5, size -= 5) {
        uint32_t place = 0;
        std::memcpy(&place, data, sizeof place);
        grid[place % grid.size()] = char(data[4]);
    }
    static_cast<void>(pbrt::readNanoGrid(grid, "grid", "density", 1 << 16));
}
#endif

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    static MemoryFile file;
    try {
#if defined(FUZZ_IMAGES)
        images::decodePicture({reinterpret_cast<const char*>(data), size}, "picture");
#elif defined(FUZZ_VOLUMES)
        mitsuba::parseVolume({reinterpret_cast<const char*>(data), size}, "volume");
#elif defined(FUZZ_NANOVDB)
        readChangedGrid(data, size);
#else
        FUZZ_LOAD(file.hold(data, size), conventions());
#endif
    } catch (const SceneError&) {
    }
    return 0;
}
