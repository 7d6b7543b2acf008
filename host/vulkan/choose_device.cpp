#include "host/vulkan/choose_device.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>

namespace stromboli::vulkan {
namespace {

constexpr const char* kAll = "all";

std::string lower(std::string s) {
    std::transform(s.begin(), s.end(), s.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return s;
}

int rank(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return 3;
    default:
        return 4;
    }
}

DeviceChoice usable(const std::vector<DeviceDescription>& devices, size_t index,
                    std::string reason) {
    if (!devices[index].usable())
        throw DeviceError(fmt::format("device {} ({}) cannot be used: it lacks {}", index,
                                      devices[index].name(), devices[index].missing));
    return {index, std::move(reason)};
}

DeviceChoice chooseBest(const std::vector<DeviceDescription>& devices) {
    size_t best = devices.size();
    for (size_t i = 0; i < devices.size(); ++i)
        if (devices[i].usable() &&
            (best == devices.size() ||
             rank(devices[i].properties.deviceType) < rank(devices[best].properties.deviceType)))
            best = i;
    if (best == devices.size())
        throw DeviceError(fmt::format("device 0 ({}) cannot be used: it lacks {}",
                                      devices[0].name(), devices[0].missing));
    return {best, fmt::format("first {} among {} device{}", devices[best].type(), devices.size(),
                              devices.size() == 1 ? "" : "s")};
}

bool matches(const DeviceDescription& d, const std::string& wanted) {
    if (wanted == "cpu") return d.isCpu();
    return lower(d.name()).find(wanted) != std::string::npos || lower(d.uuid) == wanted;
}

/// Beside a GPU, drivers of the host's processor would take little work, round in other ways, and
/// take time from the host.
std::vector<DeviceChoice> allUsable(const std::vector<DeviceDescription>& devices) {
    const bool hasGpu = std::ranges::any_of(
        devices, [](const DeviceDescription& d) { return d.usable() && !d.isCpu(); });
    std::vector<DeviceChoice> choices;
    for (size_t i = 0; i < devices.size(); ++i)
        if (devices[i].usable() && !(hasGpu && devices[i].isCpu()))
            choices.push_back({i, fmt::format("one of {} devices", devices.size())});
    if (choices.empty()) choices.push_back(chooseDevice(devices, "")); // which says what is missing
    return choices;
}

bool isPartOfAName(const std::vector<DeviceDescription>& devices, const std::string& wanted) {
    return std::ranges::any_of(
        devices, [&](const DeviceDescription& d) { return matches(d, lower(wanted)); });
}

/// "all", or a list. Names may have commas of their own.
bool namesSeveral(const std::vector<DeviceDescription>& devices, const std::string& wanted) {
    if (lower(wanted) == kAll) return true;
    return wanted.find(',') != std::string::npos && !isPartOfAName(devices, wanted);
}

std::string withoutSpaces(std::string text) {
    while (!text.empty() && text.front() == ' ')
        text.erase(text.begin());
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text;
}

} // namespace

DeviceChoice chooseDevice(const std::vector<DeviceDescription>& devices,
                          const std::string& wanted) {
    if (devices.empty())
        throw DeviceError("no Vulkan device: no driver is installed; on Debian, for a machine "
                          "without a GPU: apt install mesa-vulkan-drivers");
    if (wanted.empty()) return chooseBest(devices);
    size_t index = 0;
    const auto [end, error] = std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (error == std::errc() && end == wanted.data() + wanted.size()) {
        if (index >= devices.size())
            throw DeviceError(
                fmt::format("there is no device {}: 'stromboli devices' lists 0 to {}", index,
                            devices.size() - 1));
        return usable(devices, index, "asked for by number");
    }
    if (namesSeveral(devices, wanted))
        throw DeviceError(fmt::format("'{}' names several devices: they make pictures and shares "
                                      "of 'render' together, and nothing else",
                                      wanted));
    std::vector<size_t> found;
    for (size_t i = 0; i < devices.size(); ++i)
        if (matches(devices[i], lower(wanted))) found.push_back(i);
    if (found.empty())
        throw DeviceError(
            fmt::format("no device matches '{}': 'stromboli devices' lists them", wanted));
    if (found.size() > 1)
        throw DeviceError(fmt::format("{} devices match '{}': give a number or a UUID of "
                                      "'stromboli devices'",
                                      found.size(), wanted));
    return usable(devices, found[0], fmt::format("matches '{}'", wanted));
}

std::vector<DeviceChoice> chooseDevices(const std::vector<DeviceDescription>& devices,
                                        const std::string& wanted) {
    if (!namesSeveral(devices, wanted)) return {chooseDevice(devices, wanted)};
    if (lower(wanted) == kAll) return allUsable(devices);
    std::vector<DeviceChoice> choices;
    std::istringstream list(wanted + (wanted.back() == ',' ? "," : ""));
    for (std::string one; std::getline(list, one, ',');) {
        one = withoutSpaces(std::move(one));
        if (one.empty()) throw DeviceError(fmt::format("'{}' has an empty place", wanted));
        choices.push_back(chooseDevice(devices, one));
    }
    return choices;
}

} // namespace stromboli::vulkan
