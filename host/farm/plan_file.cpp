#include "host/farm/plan_file.hpp"

#include "host/checkpoint/byte_parts.hpp"
#include "host/checkpoint/compression.hpp"
#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/render/budget.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>

// A plan: kPlanMagic; the header of its picture, after its size; the numbers of samples that pixels
// have, then those they are to have, compressed; and a checksum of all that.

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// Changes with every change of what is written.
constexpr std::string_view kPlanMagic = "stromboli plan 1\n";

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
    throw UsageError(fmt::format("{}: {}", file.string(), why));
}

std::vector<std::byte> contentOf(const fs::path& file) {
    std::error_code failed;
    if (!fs::exists(file, failed)) refuse(file, "there is no such plan");
    const uintmax_t size = fs::file_size(file, failed);
    std::ifstream stream(file, std::ios::binary);
    if (failed || !stream) refuse(file, "cannot read the plan");
    std::vector<std::byte> bytes(size);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    if (!stream) refuse(file, "cannot read the plan");
    return bytes;
}

/// What no plan says that this program wrote.
bool isPossible(const RoundPlan& plan) {
    for (size_t i = 0; i < plan.from.size(); ++i)
        if (plan.from[i] > plan.to[i] || plan.to[i] > kMostSamples) return false;
    return plan.samples() > 0;
}

} // namespace

bool namesPlan(const fs::path& path) {
    return path.extension() == ".plan";
}

void writePlan(const fs::path& file, const RoundPlan& plan) {
    std::vector<std::byte> bytes;
    append(bytes, kPlanMagic.data(), kPlanMagic.size());
    const std::vector<std::byte> picture = toBytes(plan.picture);
    append(bytes, uint64_t(picture.size()));
    append(bytes, picture.data(), picture.size());
    std::vector<std::byte> numbers;
    append(numbers, plan.from.data(), plan.from.size() * sizeof(uint32_t));
    append(numbers, plan.to.data(), plan.to.size() * sizeof(uint32_t));
    const std::vector<std::byte> small = compressed(numbers);
    append(bytes, small.data(), small.size());
    append(bytes, checksumOf(bytes));
    writeFileAtomically(file, bytes);
}

RoundPlan readPlan(const fs::path& file) {
    const std::vector<std::byte> bytes = contentOf(file);
    if (bytes.size() < kPlanMagic.size() ||
        std::memcmp(bytes.data(), kPlanMagic.data(), kPlanMagic.size()) != 0)
        refuse(file, "not a plan of this version of the program");
    const size_t end = bytes.size() - std::min(bytes.size(), sizeof(uint32_t));
    ByteParts sum(file, "plan", std::span(bytes).subspan(end));
    if (sum.number<uint32_t>() != checksumOf(std::span(bytes).first(end)))
        refuse(file, "the plan is damaged or cut short");
    ByteParts parts(file, "plan", std::span(bytes).first(end));
    parts.take(kPlanMagic.size());
    RoundPlan plan;
    plan.picture = filmHeaderFromBytes(parts.take(parts.number<uint64_t>()), file);
    const uint64_t pixels = plan.picture.settings.area.pixelCount();
    const std::optional<std::vector<std::byte>> numbers =
        decompressed(parts.rest(), 2 * pixels * sizeof(uint32_t));
    if (!numbers) refuse(file, "the plan is damaged");
    plan.from.resize(pixels);
    plan.to.resize(pixels);
    std::memcpy(plan.from.data(), numbers->data(), pixels * sizeof(uint32_t));
    std::memcpy(plan.to.data(), numbers->data() + pixels * sizeof(uint32_t),
                pixels * sizeof(uint32_t));
    if (!isPossible(plan)) refuse(file, "the plan makes no sense");
    return plan;
}

} // namespace stromboli
