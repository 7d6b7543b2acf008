#include "tests/bench/bench_fixtures.hpp"

#include "scene/collada/load_collada.hpp"
#include "source_dir.h"

#include <filesystem>

namespace stromboli::test {

LibraryPicture libraryPicture(const std::string& name, uint32_t width, uint32_t height,
                              uint32_t samples) {
    LibraryPicture p;
    p.scene = loadCollada(
        (std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library" / (name + ".dae")).string(),
        {});
    p.settings.area.width = width;
    p.settings.area.height = height;
    p.settings.budget.mostSamplesPerPixel = samples;
    p.settings.estimator.maxBounces = 5;
    p.camera = makeCamera(p.scene, CameraChoice::Automatic, width, height);
    return p;
}

} // namespace stromboli::test
