#include "host/bvh/statistics.hpp"
#include "host/cli/activity.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/info_json.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/core/json.hpp"
#include "host/core/output.hpp"
#include "host/core/printable.hpp"
#include "host/film/image_file.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

namespace stromboli {
namespace {

void printScene(const Job& job) {
    const Scene& s = job.scene;
    const Bounds b = s.bounds();
    fmt::print("scene {} (loaded in {})\n", printable(s.file), formatDuration(job.loadSeconds));
    fmt::print("  triangles {}, spheres {}, materials {}, lights {}, cameras {}{}\n",
               s.triangles.size(), s.spheres.size(), s.materials.size(), s.lights.size(),
               s.cameras.size(), s.cglDialect ? ", CS184 dialect" : "");
    if (!s.placements.empty())
        fmt::print("  {} instances of {} meshes: {} triangles in all\n", s.placements.size(),
                   s.prototypes.size(), s.placedTriangles());
    if (!b.empty())
        fmt::print("  bounds ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) m\n", b.lo.x, b.lo.y, b.lo.z,
                   b.hi.x, b.hi.y, b.hi.z);
    for (const std::string& line : s.report.forgiven)
        fmt::print("  forgiven: {}\n", printable(line));
    for (const std::string& line : s.report.ignored)
        fmt::print("  ignored: {}\n", printable(line));
    for (const std::string& line : s.report.assumed)
        fmt::print("  {}\n", printable(line));
}

void printFileCameras(const Job& job, const Options& options) {
    const std::vector<FileCamera>& cameras = job.scene.cameras;
    const std::optional<size_t> chosen = chosenCamera(job.scene, options.camera, options.framing);
    const bool framed = isFramed(job.scene, options.camera, options.framing);
    for (size_t i = 0; i < cameras.size(); ++i)
        fmt::print("  camera {} '{}', {}{}\n", i + 1, printable(cameras[i].name),
                   cameras[i].projection == Projection::Perspective ? "perspective"
                                                                    : "orthographic",
                   !framed && chosen == i ? ": taken" : "");
}

void printCamera(const Job& job) {
    const Camera& c = job.camera;
    fmt::print(
        "picture {} x {}, {} camera at ({:g}, {:g}, {:g}) looking along ({:g}, {:g}, {:g})\n",
        job.settings.area.width, job.settings.area.height,
        c.orthographic ? "orthographic" : "perspective", c.position.x, c.position.y, c.position.z,
        -c.back.x, -c.back.y, -c.back.z);
}

void printBvh(const BuiltScene& built) {
    const BvhStatistics s = measure(built.gpu.bvh);
    fmt::print("BVH (built in {})\n", formatDuration(built.buildSeconds));
    fmt::print("  nodes {} with {:.1f} children, leaves {} with {:.2f} primitives, depth {}\n",
               s.nodes, s.childrenPerNode(), s.leaves, s.primitivesPerLeaf(), s.depth);
    fmt::print("  {:.1f} records on a line's way, {:.1f} bytes per primitive\n", s.expectedVisits,
               s.bytesPerPrimitive());
}

/// Of what a picture of this program says in its file.
int infoOfPicture(const Options& options) {
    const PictureNotes notes = readPictureNotes(options.scene);
    nowDoing("printing", StatusLine::OfOthers);
    if (!options.infoJsonFile.empty()) {
        Json json = Json::object();
        for (const PictureNote& note : notes)
            json[note.name] = printable(note.text);
        writeOutput(options.infoJsonFile, json.dump(2) + "\n");
        return 0;
    }
    fmt::print("picture {}{}\n", printable(options.scene),
               notes.empty() ? ": its file says nothing of how it was made" : "");
    for (const PictureNote& note : notes)
        fmt::print("  {}: {}\n", printable(note.name), printable(note.text));
    return 0;
}

} // namespace

int infoCommand(const Options& options) {
    if (namesPicture(options.scene)) return infoOfPicture(options);
    const Job job = prepareJob(options);
    const BuiltScene built = buildScene(job);
    nowDoing("printing", StatusLine::OfOthers);
    if (!options.infoJsonFile.empty()) {
        writeOutput(options.infoJsonFile, infoJson(job, built).dump(2) + "\n");
        return 0;
    }
    printScene(job);
    printFileCameras(job, options);
    printCamera(job);
    printBvh(built);
    fmt::print("kernel (only what the scene needs)\n");
    for (const std::string& line :
         describe(kernelFeatures(built.gpu, job.camera, job.settings.estimator, {})))
        fmt::print("  {}\n", line);
    fmt::print("buffers on the device\n");
    uint64_t total = 0;
    for (const vulkan::BufferPlan& b :
         planBuffers(built.gpu, job.settings.area, job.settings.estimator, {})) {
        fmt::print("  {:<26} {:>12} bytes\n", b.name, b.bytes);
        total += b.bytes;
    }
    fmt::print("  {:<26} {:>12} bytes\n", "together", total);
    return 0;
}

} // namespace stromboli
