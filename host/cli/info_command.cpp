#include "host/bvh/statistics.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/declared_command.hpp"
#include "host/cli/kept_files.hpp"
#include "host/cli/progress.hpp"
#include "host/core/files.hpp"
#include "host/core/json.hpp"
#include "host/core/printable.hpp"
#include "host/engine/load_scene.hpp"
#include "host/film/image_file.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/vulkan_backend.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {
namespace {

template <class Vector>
Json vector(const Vector& v) {
    return Json{double(v.x), double(v.y), double(v.z)};
}

Json sceneJson(const LoadedScene& scene) {
    const Scene& s = *scene.scene;
    const Bounds b = s.bounds();
    return {
        {"file", s.file},
        {"loadSeconds", scene.seconds},
        {"triangles", s.triangles.size()},
        {"instances", s.placements.size()},
        {"placedTriangles", s.placedTriangles()},
        {"spheres", s.spheres.size()},
        {"materials", s.materials.size()},
        {"lights", s.lights.size()},
        {"cameras", s.cameras.size()},
        {"cs184Dialect", s.cglDialect},
        {"origin", vector(s.origin)}, // of all positions here, in the file's coordinates
        {"bounds", b.empty() ? Json(nullptr) : Json{{"low", vector(b.lo)}, {"high", vector(b.hi)}}},
        {"ignored", s.report.ignored},
        {"forgiven", s.report.forgiven},
        {"warnings", s.report.warnings}};
}

Json pictureJson(const ResolvedPicture& picture) {
    const Camera& c = picture.camera;
    return {{"width", picture.settings.area.width},
            {"height", picture.settings.area.height},
            {"camera", c.orthographic ? "orthographic" : "perspective"},
            {"position", vector(c.position)},
            {"direction", vector(-c.back)}};
}

Json bvhJson(const BuiltScene& built) {
    const BvhStatistics s = measure(built.gpu.bvh);
    return {{"buildSeconds", built.seconds},
            {"nodes", s.nodes},
            {"childrenPerNode", s.childrenPerNode()},
            {"leaves", s.leaves},
            {"primitivesPerLeaf", s.primitivesPerLeaf()},
            {"depth", s.depth},
            {"recordsOnALinesWay", s.expectedVisits},
            {"bytesPerPrimitive", s.bytesPerPrimitive()}};
}

Json buffersJson(const ResolvedPicture& picture, const BuiltScene& built) {
    Json buffers = Json::array();
    for (const vulkan::BufferPlan& b :
         planBuffers(built.gpu, picture.settings.area, picture.settings.estimator, {}))
        buffers.push_back({{"name", b.name}, {"bytes", b.bytes}});
    return buffers;
}

/// All features, those that the kernel lacks as well.
/// Steps between two services as a CPU device takes them: a GPU's do not depend on the scene.
const DeviceTuning kOnACpu{.stepsFitRays = true};

Json kernelJson(const ResolvedPicture& picture, const BuiltScene& built) {
    const KernelFeatures values =
        kernelFeatures(built.gpu, picture.camera, picture.settings.estimator, kOnACpu);
    Json features = Json::array();
    for (const Feature& f : featureTable())
        features.push_back({{"name", f.name},
                            {"label", f.label},
                            {"value", values[f.constant]},
                            {"text", valueText(f, values[f.constant])},
                            {"adds", f.adds}});
    return features;
}

Json infoJson(const PreparedPicture& prepared, const BuiltScene& built) {
    const auto& [scene, picture] = prepared;
    return {{"scene", sceneJson(scene)},
            {"picture", pictureJson(picture)},
            {"bvh", bvhJson(built)},
            {"kernel", kernelJson(picture, built)},
            {"buffers", buffersJson(picture, built)}};
}

void printScene(const LoadedScene& scene) {
    const Scene& s = *scene.scene;
    const Bounds b = s.bounds();
    fmt::print("scene {} (loaded in {})\n", printable(s.file), formatDuration(scene.seconds));
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

void printFileCameras(const Scene& scene, const RenderRequest& request) {
    const std::vector<FileCamera>& cameras = scene.cameras;
    const std::optional<size_t> chosen = chosenCamera(scene, request.camera, request.framing);
    const bool framed = isFramed(scene, request.camera, request.framing);
    for (size_t i = 0; i < cameras.size(); ++i)
        fmt::print("  camera {} '{}', {}{}\n", i + 1, printable(cameras[i].name),
                   cameras[i].projection == Projection::Perspective ? "perspective"
                                                                    : "orthographic",
                   !framed && chosen == i ? ": taken" : "");
}

void printCamera(const ResolvedPicture& picture) {
    const Camera& c = picture.camera;
    fmt::print(
        "picture {} x {}, {} camera at ({:g}, {:g}, {:g}) looking along ({:g}, {:g}, {:g})\n",
        picture.settings.area.width, picture.settings.area.height,
        c.orthographic ? "orthographic" : "perspective", c.position.x, c.position.y, c.position.z,
        -c.back.x, -c.back.y, -c.back.z);
}

void printBvh(const BuiltScene& built) {
    const BvhStatistics s = measure(built.gpu.bvh);
    fmt::print("BVH (built in {})\n", formatDuration(built.seconds));
    fmt::print("  nodes {} with {:.1f} children, leaves {} with {:.2f} primitives, depth {}\n",
               s.nodes, s.childrenPerNode(), s.leaves, s.primitivesPerLeaf(), s.depth);
    fmt::print("  {:.1f} records on a line's way, {:.1f} bytes per primitive\n", s.expectedVisits,
               s.bytesPerPrimitive());
}

/// What the file of a picture says of how it was made.
int infoOfPicture(const std::string& file, const std::string& jsonFile) {
    const PictureNotes notes = readPictureNotes(file);
    nowDoing("printing", StatusLine::OfOthers);
    if (!jsonFile.empty()) {
        Json json = Json::object();
        for (const PictureNote& note : notes)
            json[note.name] = printable(note.text);
        writeOutput(jsonFile, json.dump(2) + "\n");
        return 0;
    }
    fmt::print("picture {}{}\n", printable(file),
               notes.empty() ? ": its file says nothing of how it was made" : "");
    for (const PictureNote& note : notes)
        fmt::print("  {}: {}\n", printable(note.name), printable(note.text));
    return 0;
}

} // namespace

void declareInfo(DeclaredCommand& c) {
    const auto o = std::make_shared<InfoOptions>();
    const auto asked = std::make_shared<Asked>();
    asked->branchesPay = true;
    declareScene(c.list, o->scene);
    declarePicture(c.list, o->picture, *asked);
    declareEstimator(c.list, *o, *asked);
    declareSampler(c.list, o->picture.estimator.sampler);
    c.list.group("Output");
    c.list
        .text("--json", "FILE.json", "write all of it as JSON instead; - for standard output",
              o->jsonFile)
        .proposes(Proposed::Files);
    declareHost(c);
    finishesAsPicture(c, o, asked);
}

int infoCommand(const InfoOptions& options) {
    if (namesPicture(options.scene.source))
        return infoOfPicture(options.scene.source, options.jsonFile);
    if (isKeptRender(options.scene.source))
        return infoOfKeptRender(options.scene.source, options.jsonFile);
    PreparedPicture prepared = preparePicture(options);
    const auto& [scene, picture] = prepared;
    const RenderSettings& settings = picture.settings;
    BuiltScene built = buildScene(*scene.scene, settings.estimator, toTerminal());
    fitToPicture(built.gpu, *scene.scene, picture.camera, settings.estimator);
    nowDoing("printing", StatusLine::OfOthers);
    if (!options.jsonFile.empty()) {
        writeOutput(options.jsonFile, infoJson(prepared, built).dump(2) + "\n");
        return 0;
    }
    printScene(scene);
    printFileCameras(*scene.scene, options.picture);
    printCamera(picture);
    printBvh(built);
    fmt::print("kernel (only what the scene needs)\n");
    for (const std::string& line :
         describe(kernelFeatures(built.gpu, picture.camera, settings.estimator, kOnACpu)))
        fmt::print("  {}\n", line);
    fmt::print("buffers on the device\n");
    uint64_t total = 0;
    for (const vulkan::BufferPlan& b :
         planBuffers(built.gpu, settings.area, settings.estimator, {})) {
        fmt::print("  {:<26} {:>12} bytes\n", b.name, b.bytes);
        total += b.bytes;
    }
    fmt::print("  {:<26} {:>12} bytes\n", "together", total);
    return 0;
}

} // namespace stromboli
