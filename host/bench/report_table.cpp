#include "host/bench/report.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>

namespace stromboli::bench {

namespace {

std::string ratio(const Spread& s) {
    return fmt::format("x {:.2f} [{:.2f} {:.2f}]", s.median, s.least, s.most);
}

std::string comparison(const Series& ours, const Series& other, bool deviceIsCpu) {
    std::string text = ratio(speedup(ours.wallSeconds, other.wallSeconds));
    if (deviceIsCpu) // a GPU's work is no CPU time
        text += fmt::format(", by CPU time x {:.2f}",
                            speedup(ours.cpuSeconds, other.cpuSeconds).median);
    return text;
}

std::string compared(const std::vector<Series>& all, size_t i, bool deviceIsCpu) {
    return i == 0 ? "" : comparison(all[0], all[i], deviceIsCpu);
}

/// A line for each contestant: millions of items per second, CPU time of one, how much faster
/// ours is.
std::string rates(const std::vector<Series>& all, bool deviceIsCpu) {
    std::string text;
    for (size_t i = 0; i < all.size(); ++i) {
        const Spread rate = all[i].wallRate();
        text += fmt::format(
            "    {:<20}{:>8.2f} M/s {:<17} CPU {:>7.1f} ns  {}", all[i].name, rate.median * 1e-6,
            fmt::format("[{:.2f} {:.2f}]", rate.least * 1e-6, rate.most * 1e-6),
            spreadOf(all[i].cpuSeconds).median * 1e9, compared(all, i, deviceIsCpu));
        if (!all[i].deviceSeconds.empty())
            text += fmt::format("{}{:.2f} M/s by the device's clock", i == 0 ? "" : "; ",
                                1e-6 / spreadOf(all[i].deviceSeconds).median);
        text.erase(text.find_last_not_of(' ') + 1);
        text += "\n";
    }
    return text;
}

/// A line for each contestant: seconds.
std::string durations(const std::vector<Series>& all) {
    std::string text;
    for (size_t i = 0; i < all.size(); ++i) {
        const Spread wall = spreadOf(all[i].wallSeconds);
        text += fmt::format("    {:<26}{:>9.2f} ms {:<19} CPU {:>8.2f} ms  {}", all[i].name,
                            wall.median * 1e3,
                            fmt::format("[{:.2f} {:.2f}]", wall.least * 1e3, wall.most * 1e3),
                            spreadOf(all[i].cpuSeconds).median * 1e3, compared(all, i, true));
        text.erase(text.find_last_not_of(' ') + 1);
        text += "\n";
    }
    return text;
}

std::string head(const Circumstances& c) {
    std::string text = fmt::format("stromboli {}, {}\n{}\n", c.version, c.date, c.commandLine);
    text +=
        fmt::format("CPU     {}, {} cores; {} threads; {}\n", c.cpu, c.cores, c.threads, c.system);
    text += fmt::format("device  {}; {}\n", c.device, c.driver);
    text += fmt::format("built   {}\n", c.compiler);
    if (c.embreeMissing.empty())
        text += fmt::format("Embree  {}; ray loops: {}\n", c.embreeVersion, c.embreeFlags);
    else
        text += fmt::format("Embree  none: {}\n", c.embreeMissing);
    text += "Medians [least most]; x: how many times faster ours is, from the ratios of each "
            "round\n";
    return text;
}

std::string table(const BvhReport& b) {
    std::string text = "  BVH build\n" + durations(b.builds) + durations({b.binaryTree});
    text += fmt::format("    {:.1f} records on a line's way; {:.1f} bytes a primitive on the "
                        "device",
                        b.expectedVisits, b.bytesPerPrimitive);
    if (b.embreeBytesPerPrimitive > 0)
        text += fmt::format(", Embree {:.1f}", b.embreeBytesPerPrimitive);
    return text + "\n";
}

std::string table(const RayReport& r, bool deviceIsCpu) {
    std::string text =
        fmt::format("  {} rays: {}, {:.1f} % hit, {:.1f} nodes and {:.1f} leaves each", r.kind,
                    r.rays, 100 * r.hitShare, r.nodes, r.leaves);
    for (size_t i = 0; i < r.disagreements.size(); ++i)
        text += fmt::format("; {} disagrees on {}", r.contestants[i + 1].name, r.disagreements[i]);
    return text + "\n" + rates(r.contestants, deviceIsCpu);
}

std::string table(const PathReport& p, bool deviceIsCpu) {
    std::string text = fmt::format("  paths of {:.2f} rays\n", p.raysPerPath);
    text += rates(p.contestants, deviceIsCpu);
    if (p.driverBusy > 0)
        text += fmt::format("    driver threads busy {:.1f} %\n", 100 * p.driverBusy);
    if (p.lanesBusy > 0)
        text += fmt::format("    lanes busy in traversal steps {:.1f} %\n", 100 * p.lanesBusy);
    return text;
}

std::string table(const VariantReport& v, bool deviceIsCpu) {
    std::string text = "  kernel variants\n" + rates(v.contestants, deviceIsCpu);
    for (size_t i = 0; i < v.samePicture.size(); ++i)
        text += fmt::format("    {}: {} picture\n", v.contestants[i + 1].name,
                            v.samePicture[i] ? "the same" : "ANOTHER");
    return text;
}

std::string table(const TextureReport& t, bool deviceIsCpu) {
    return fmt::format("  rays of paths with textures ({:.2f} a path) and with their means "
                       "({:.2f}): x below 1 is what textures cost\n",
                       t.raysPerPath.at(0), t.raysPerPath.at(1)) +
           rates(t.contestants, deviceIsCpu);
}

std::string table(const SceneReport& s, bool deviceIsCpu) {
    std::string text = fmt::format(
        "\n{}: {} triangles, {} spheres; {} x {}, {} samples, {} bounces{}\n", s.name, s.triangles,
        s.spheres, s.width, s.height, s.samplesPerPixel, s.maxBounces,
        s.embreeQuality.empty() ? ""
                                : "; Embree traces what its " + s.embreeQuality + " quality built");
    if (s.bvh) text += table(*s.bvh);
    for (const RayReport& r : s.rays)
        text += table(r, deviceIsCpu);
    if (s.paths) text += table(*s.paths, deviceIsCpu);
    if (s.variants) text += table(*s.variants, deviceIsCpu);
    if (s.textures) text += table(*s.textures, deviceIsCpu);
    return text;
}

/// From the first size to the last, in wall time: nanoseconds, and how many times.
std::string increase(const std::vector<GrowthPoint>& growth) {
    std::string text = "  grows by:";
    for (size_t i = 0; i < growth.front().bounce.contestants.size(); ++i) {
        const auto time = [&](const GrowthPoint& g) {
            return spreadOf(g.bounce.contestants.at(i).wallSeconds).median * 1e9;
        };
        const double first = time(growth.front()), last = time(growth.back());
        text += fmt::format("{:>18}", fmt::format("{:.1f} (x {:.2f})", last - first, last / first));
    }
    return text + "   wall time, the last size against the first\n";
}

std::string table(const std::vector<GrowthPoint>& growth) {
    if (growth.empty()) return {};
    std::string text = "\ntime for a bounce ray as the scene grows, ns (in brackets CPU time)\n"
                       "  triangles";
    for (const Series& s : growth.front().bounce.contestants)
        text += fmt::format("{:>18}", s.name);
    text += "   builds, ms: ours, Embree's (fast)\n";
    for (const GrowthPoint& g : growth) {
        text += fmt::format("{:>11}", g.triangles);
        for (const Series& s : g.bounce.contestants)
            text += fmt::format("{:>18}",
                                fmt::format("{:.1f} ({:.1f})", spreadOf(s.wallSeconds).median * 1e9,
                                            spreadOf(s.cpuSeconds).median * 1e9));
        text +=
            fmt::format("{:>14.1f}{:>12.1f}\n", g.buildSeconds * 1e3, g.embreeBuildSeconds * 1e3);
    }
    if (growth.size() > 1) text += increase(growth);
    return text;
}

std::string stages(const char* name, const StartupReport::Stages& s) {
    return fmt::format("    {}: device {:.1f}, scene {:.1f}, BVH {:.1f}, buffers and pipeline "
                       "{:.1f}, first dispatch {:.1f}, second {:.1f} ms\n",
                       name, s.device * 1e3, s.load * 1e3, s.build * 1e3, s.pipeline * 1e3,
                       s.firstDispatch * 1e3, s.secondDispatch * 1e3);
}

std::string table(const StartupReport& s) {
    return "\nstart-up: render, 64 x 64, one sample, whole process\n" + durations(s.wholeProcess) +
           stages("cold", s.cold) + stages("warm", s.warm);
}

std::string table(const TransferReport& t) {
    std::string text = fmt::format("\ntransfer of {} MiB\n", t.bytes >> 20);
    for (const Series& s : t.directions) {
        const Spread rate = s.wallRate();
        text += fmt::format("    {:<20}{:>8.2f} ms {:>7.2f} GB/s [{:.2f} {:.2f}]\n", s.name,
                            spreadOf(s.wallSeconds).median * double(t.bytes) * 1e3,
                            rate.median * 1e-9, rate.least * 1e-9, rate.most * 1e-9);
    }
    return text;
}

} // namespace

std::string toTable(const BenchReport& report) {
    std::string text = head(report.circumstances);
    for (const SceneReport& s : report.scenes)
        text += table(s, report.circumstances.deviceIsCpu);
    text += table(report.growth);
    if (report.startup) text += table(*report.startup);
    if (report.transfer) text += table(*report.transfer);
    return text;
}

} // namespace stromboli::bench
