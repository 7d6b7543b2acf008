#include "host/check/cross_check.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

constexpr const char* kChannelNames[] = {"red", "green", "blue"};

const char* verdict(bool agrees) {
    return agrees ? "ok" : "DIFFERENT";
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
    text += fmt::format("verdict: {}\n", r.agree() ? "the pictures agree" : "DIFFERENT");
    return text;
}

} // namespace stromboli
