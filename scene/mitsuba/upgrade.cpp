#include "scene/mitsuba/upgrade.hpp"

#include <algorithm>
#include <cctype>

namespace stromboli::mitsuba {

std::string upgradedName(std::string_view name) {
    std::string upgraded;
    bool afterSmall = false;
    for (const char c : name) {
        const bool isCapital = std::isupper(static_cast<unsigned char>(c)) != 0;
        if (isCapital && afterSmall) upgraded += '_';
        upgraded += isCapital ? char(std::tolower(static_cast<unsigned char>(c))) : c;
        afterSmall = std::islower(static_cast<unsigned char>(c)) != 0;
    }
    return upgraded;
}

std::string inSmallLetters(std::string_view type) {
    std::string name(type);
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return name;
}

std::string upgradedType(std::string_view tag, std::string_view type) {
    if (tag == "film" && (type == "ldrfilm" || type == "mfilm" || type == "tiledhdrfilm"))
        return "hdrfilm";
    if (tag == "integrator" && type == "volpath_simple") return "volpath";
    return std::string(type);
}

} // namespace stromboli::mitsuba
