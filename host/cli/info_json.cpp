#include "host/cli/info_json.hpp"

#include "host/bvh/statistics.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"

namespace stromboli {
namespace {

template <class Vector>
Json vector(const Vector& v) {
    return Json{double(v.x), double(v.y), double(v.z)};
}

Json sceneJson(const Job& job) {
    const Scene& s = job.scene;
    const Bounds b = s.bounds();
    return {
        {"file", s.file},
        {"loadSeconds", job.loadSeconds},
        {"triangles", s.triangles.size()},
        {"instances", s.placements.size()},
        {"placedTriangles", s.placedTriangles()},
        {"spheres", s.spheres.size()},
        {"materials", s.materials.size()},
        {"lights", s.lights.size()},
        {"cameras", s.cameras.size()},
        {"cs184Dialect", s.cglDialect},
        {"bounds", b.empty() ? Json(nullptr) : Json{{"low", vector(b.lo)}, {"high", vector(b.hi)}}},
        {"ignored", s.report.ignored},
        {"forgiven", s.report.forgiven},
        {"warnings", s.report.warnings}};
}

Json pictureJson(const Job& job) {
    const Camera& c = job.camera;
    return {{"width", job.settings.area.width},
            {"height", job.settings.area.height},
            {"camera", c.orthographic ? "orthographic" : "perspective"},
            {"position", vector(c.position)},
            {"direction", vector(-c.back)}};
}

Json bvhJson(const BuiltScene& built) {
    const BvhStatistics s = measure(built.gpu.bvh);
    return {
        {"buildSeconds", built.buildSeconds},         {"nodes", s.nodes},
        {"childrenPerNode", s.childrenPerNode()},     {"leaves", s.leaves},
        {"primitivesPerLeaf", s.primitivesPerLeaf()}, {"depth", s.depth},
        {"recordsOnALinesWay", s.expectedVisits},     {"bytesPerPrimitive", s.bytesPerPrimitive()}};
}

Json buffersJson(const Job& job, const BuiltScene& built) {
    Json buffers = Json::array();
    for (const vulkan::BufferPlan& b :
         planBuffers(built.gpu, job.settings.area, job.settings.estimator, {}))
        buffers.push_back({{"name", b.name}, {"bytes", b.bytes}});
    return buffers;
}

/// All features, those that the kernel lacks as well.
Json kernelJson(const Job& job, const BuiltScene& built) {
    const KernelFeatures values = kernelFeatures(built.gpu, job.camera, job.settings.estimator, {});
    Json features = Json::array();
    for (const Feature& f : featureTable())
        features.push_back({{"name", f.name},
                            {"label", f.label},
                            {"value", values[f.constant]},
                            {"text", valueText(f, values[f.constant])},
                            {"adds", f.adds}});
    return features;
}

} // namespace

Json infoJson(const Job& job, const BuiltScene& built) {
    return {{"scene", sceneJson(job)},
            {"picture", pictureJson(job)},
            {"bvh", bvhJson(built)},
            {"kernel", kernelJson(job, built)},
            {"buffers", buffersJson(job, built)}};
}

} // namespace stromboli
