// One program for each format: libFuzzer gives it mutated files, which the loader may refuse with a
// SceneError and with nothing else. tests/fuzz/run builds and runs them.
#include "host/core/error.hpp"
#include "scene/collada/load_collada.hpp"
#include "scene/gltf/load_gltf.hpp"
#include "scene/images/picture.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"
#include "scene/mitsuba/volumes.hpp"
#include "scene/obj/load_obj.hpp"
#include "scene/pbrt/load_pbrt.hpp"
#include "scene/ply/load_ply.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
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

#if !defined(FUZZ_IMAGES) && !defined(FUZZ_VOLUMES)
/// Large pictures would take nearly all of the time, and find nothing that small ones do not.
SceneConventions conventions() {
    SceneConventions result;
    result.selection.largestTexture = 16;
    return result;
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
#else
        FUZZ_LOAD(file.hold(data, size), conventions());
#endif
    } catch (const SceneError&) {
    }
    return 0;
}
