#include "host/bvh/statistics.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/job.hpp"
#include "host/cli/progress.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "host/kernel/kernel_features.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

void printScene(const Job& job) {
    const Scene& s = job.scene;
    const Bounds b = s.bounds();
    fmt::print("scene {} (loaded in {})\n", s.file, formatDuration(job.loadSeconds));
    fmt::print("  triangles {}, spheres {}, materials {}, lights {}, cameras {}{}\n",
               s.triangles.size(), s.spheres.size(), s.materials.size(), s.lights.size(),
               s.cameras.size(), s.cglDialect ? ", CS184 dialect" : "");
    if (!b.empty())
        fmt::print("  bounds ({:g}, {:g}, {:g}) to ({:g}, {:g}, {:g}) m\n", b.lo.x, b.lo.y, b.lo.z,
                   b.hi.x, b.hi.y, b.hi.z);
    for (const std::string& line : s.report.ignored)
        fmt::print("  ignored: {}\n", line);
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

} // namespace

int infoCommand(const Options& options) {
    const Job job = prepareJob(options);
    const BuiltScene built = buildScene(job);
    printScene(job);
    printCamera(job);
    printBvh(built);
    fmt::print("kernel (only what the scene needs)\n");
    for (const std::string& line :
         describe(kernelFeatures(built.gpu, job.camera, job.settings.estimator, {})))
        fmt::print("  {}\n", line);
    fmt::print("buffers on the device\n");
    uint64_t total = 0;
    for (const vulkan::BufferPlan& b :
         planBuffers(built.gpu, job.settings.area, job.settings.estimator.branches, {})) {
        fmt::print("  {:<26} {:>12} bytes\n", b.name, b.bytes);
        total += b.bytes;
    }
    fmt::print("  {:<26} {:>12} bytes\n", "together", total);
    return 0;
}

} // namespace stromboli
