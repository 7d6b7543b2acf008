#include "host/check/cross_check.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli {
namespace {

constexpr const char* kChannelNames[] = {"red", "green", "blue"};

const char* verdict(bool agrees) {
    return agrees ? "ok" : "DIFFERENT";
}

std::string percent(const CheckChannel& c) {
    if (c.isBlack) return "black";
    return std::isfinite(c.visible) ? fmt::format("{:.3g} %", 100 * c.visible) : "nothing";
}

/// What the test of the means was able to see, whatever it found.
std::string formatSight(const CheckResult& r) {
    if (r.varied == 0) return "sight      unknown: no pixel has two samples\n";
    return fmt::format("sight      differences of the means found with {:g} % probability: from {} "
                       "(red), {} (green), {} (blue)\n",
                       100 * r.power, percent(r.channels[0]), percent(r.channels[1]),
                       percent(r.channels[2]));
}

std::string finalWord(const CheckResult& r) {
    switch (r.verdict()) {
    case Verdict::Agree:
        return "the pictures agree";
    case Verdict::Different:
        return "DIFFERENT";
    case Verdict::Undecided:
        break;
    }
    return r.varied == 0
               ? "UNDECIDED: no pixel has two samples, and so nothing tells noise from a difference"
               : "UNDECIDED: the noise would hide it if one picture were black; take more samples";
}

} // namespace

std::string formatCheck(const CheckResult& r) {
    if (r.pixels == 0) return "no pixel has samples in both pictures\nverdict: DIFFERENT\n";
    std::string text;
    for (int c = 0; c < 3; ++c) {
        const CheckChannel& channel = r.channels[c];
        text +=
            fmt::format("mean {:<6} {:.6g} and {:.6g}, {:+.3f} %, z = {:+.2f}\n", kChannelNames[c],
                        channel.meanA, channel.meanB, 100 * channel.relativeDifference, channel.z);
    }
    text += fmt::format("means      |z| <= {:.2f}: {}\n", r.channelLimit, verdict(r.channelsAgree));
    text += formatSight(r);
    const CheckBlock& block = r.worstBlock;
    text += fmt::format(
        "blocks     |z| <= {:.2f}: {}; worst z = {:+.2f} of {} at ({}, {}), {} x {}, {}\n",
        r.blockLimit, verdict(r.blocksAgree), block.z, r.blockTests, block.x, block.y, block.width,
        block.height, kChannelNames[block.channel]);
    text +=
        fmt::format("pixels     {:.3f} % with |z| <= {:.2f}: {}; worst z = {:+.2f} at "
                    "({}, {}), {}\n",
                    100 * r.fractionPassing, r.pixelLimit, verdict(r.pixelsAgree), r.worstPixel.z,
                    r.worstPixel.x, r.worstPixel.y, kChannelNames[r.worstPixel.channel]);
    text += fmt::format("constants  {} of {} pixels differ: {}\n", r.constantMismatches, r.pixels,
                        verdict(r.constantsAgree));
    if (r.rejectedA + r.rejectedB > 0)
        text += fmt::format("samples rejected: {} and {}\n", r.rejectedA, r.rejectedB);
    text += fmt::format("verdict: {}\n", finalWord(r));
    return text;
}

} // namespace stromboli
