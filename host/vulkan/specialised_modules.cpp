#include "host/vulkan/specialised_modules.hpp"

#include "host/spirv/specialise.hpp"

#include <fmt/format.h>

#include <cstring>
#include <string_view>

namespace stromboli::vulkan {
namespace {

using Words = std::span<const uint32_t>;

uint64_t hashOf(Words words) {
    const auto bytes = std::as_bytes(words);
    return std::hash<std::string_view>()(
        {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

void append(std::vector<uint32_t>& words, uint64_t number) {
    words.insert(words.end(), {uint32_t(number), uint32_t(number >> 32)});
}

/// What a module is made from: the specialiser, by its source, the code, by hash and length, and
/// the constants.
std::vector<uint32_t> keyOfModule(Words module, Words constants) {
    constexpr std::string_view kSpecialiser = STROMBOLI_SPECIALISER;
    std::vector<uint32_t> key((kSpecialiser.size() + 3) / 4);
    std::memcpy(key.data(), kSpecialiser.data(), kSpecialiser.size());
    append(key, hashOf(module));
    append(key, module.size());
    append(key, constants.size());
    key.insert(key.end(), constants.begin(), constants.end());
    return key;
}

} // namespace

std::optional<std::vector<uint32_t>> SpecialisedModules::get(Words module, Words constants) const {
    if (!kept_ || module.size() < kLeastWords) return spirv::specialise(module, constants);
    std::vector<uint32_t> key = keyOfModule(module, constants);
    const std::string name = fmt::format("kernel-{:016x}", hashOf(key));
    // A blob begins with its key, so that one of another key with the same hash is not taken.
    if (const auto blob = kept_->find(name); blob && blob->size() % sizeof(uint32_t) == 0) {
        std::vector<uint32_t> found(blob->size() / sizeof(uint32_t));
        std::memcpy(found.data(), blob->data(), blob->size());
        if (found.size() > key.size() && std::equal(key.begin(), key.end(), found.begin()))
            return std::vector(found.begin() + std::ptrdiff_t(key.size()), found.end());
    }
    const auto made = spirv::specialise(module, constants);
    if (made) {
        key.insert(key.end(), made->begin(), made->end());
        kept_->keep(name, std::as_bytes(std::span(key)));
    }
    return made;
}

} // namespace stromboli::vulkan
