#include "host/bench/transfer_bench.hpp"

#include "host/vulkan/buffer.hpp"

namespace stromboli::bench {
namespace {

constexpr uint64_t kBytes = uint64_t(64) << 20; ///< the size of a large scene's buffers

} // namespace

TransferReport benchTransfer(const vulkan::Device& device, const AlternatePlan& plan) {
    vulkan::Queue queue(device);
    vulkan::Buffer buffer(device, "buffer of the transfer benchmark", kBytes,
                          vulkan::BufferUse::Storage);
    std::vector<std::byte> data(kBytes, std::byte{1});
    TransferReport report;
    report.bytes = kBytes;
    report.directions = alternate({{"upload",
                                    [&] {
                                        buffer.upload(queue, data);
                                        return Work{double(kBytes), 0};
                                    }},
                                   {"readback",
                                    [&] {
                                        buffer.download(queue, data);
                                        return Work{double(kBytes), 0};
                                    }}},
                                  plan);
    return report;
}

} // namespace stromboli::bench
