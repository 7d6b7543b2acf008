// The device's pictures against those of the reference, an independent path tracer in double
// precision on the CPU.
#include "host/check/cross_check.hpp"
#include "host/core/error.hpp"
#include "host/reference/reference_backend.hpp"
#include "host/stress/case.hpp"
#include "scene/read_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace stromboli::stress {
namespace {

std::vector<std::filesystem::path> bundledScenes() {
    const std::filesystem::path folder = STROMBOLI_SCENE_LIBRARY;
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error))
        if (entry.path().extension() == ".dae") files.push_back(entry.path());
    if (files.empty())
        throw SceneError(fmt::format("{}: the bundled scenes are not here", folder.string()));
    std::sort(files.begin(), files.end());
    return files;
}

/// Share of the pixels that fail their own test; 1 for a picture whose mean, blocks or constant
/// pixels differ. A right renderer fails one run in a hundred seeds, all scenes together; the seed
/// is fixed.
Finding agreement(Run& run) {
    Finding f;
    f.bound = 1 - CheckSettings{}.requiredFraction;
    const auto files = bundledScenes();
    CheckSettings check;
    check.familyError = 0.01 / double(files.size());
    RenderSettings s;
    s.area.width = run.amount(32u, 160u), s.area.height = run.amount(24u, 120u);
    s.budget.mostSamplesPerPixel = run.amount(32u, 256u);
    s.estimator.maxBounces = 5;
    double done = 0;
    for (const auto& file : files) {
        const Scene scene = readScene(file.string());
        const Camera camera =
            makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
        const Film onDevice = run.render(scene, camera, s).film;
        ReferenceBackend reference(scene, camera, s);
        const Film onHost = render(reference, s, [&](const RenderProgress&) {
            run.goOn();
            return true;
        });
        const CheckResult result = crossCheck(onDevice, onHost, check);
        const double failing = result.agree() ? 1 - result.fractionPassing : 1;
        if (!(failing <= f.measured)) f.measured = failing, f.where = file.stem().string();
        f.trials += result.pixels;
        ++done;
    }
    return f;
}

} // namespace

std::vector<Case> agreementCases() {
    return {{"agreement", "62", "every bundled scene: the reference's picture", "share that fails",
             "pixels", agreement}};
}

} // namespace stromboli::stress
