#include "scene/obj/blender.hpp"

#include "scene/build/number_word.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::obj {

std::optional<Blender> blenderOf(std::string_view text) {
    constexpr std::string_view mark = "# Blender ";
    if (!text.starts_with(mark)) return std::nullopt;
    text.remove_prefix(mark.size());
    // Since 3.1 the version stands there, and since then Ns goes up to 1000; it was 900 before.
    // From 4.0 on the specular level belongs to the index.
    const std::optional<uint32_t> version = build::countIn(text.substr(0, text.find('.')));
    return Blender{version ? 1000.0 : 900.0, version.value_or(0) >= 4};
}

void takeMeaningOf(const Blender& blender, MtlMaterial& m) {
    if (m.exponent && !m.roughness) {
        const double share = std::clamp(*m.exponent / blender.largestExponent, 0.0, 1.0);
        m.roughness = 1 - std::sqrt(share);
    }
    // Metals have the model of mirrors, with the metallic share as Ka.
    const double illumination = m.illumination.value_or(2);
    if (!m.metallic && (illumination == 3 || illumination == 6))
        m.metallic = m.ambient ? std::clamp(m.ambient->x, 0.0, 1.0) : 1;
    if (m.specular) m.specularLevel = 2.0 * *m.specular; // one half is usual
    m.specular.reset();
    if (m.filter) m.transmission = std::clamp(m.filter->x, 0.0, 1.0);
    if (!blender.hasLevels && m.transmission == 0) m.ior.reset();
    if (!m.roughnessMap) m.roughnessMap = m.exponentMap;
    if (!m.metallicMap) m.metallicMap = m.reflectionMap;
    if (!m.normalMap) m.normalMap = m.bumpMap;
    m.bumpMap.reset();
    // A picture takes the place of a number.
    if (m.roughnessMap) m.roughness.reset();
    if (m.metallicMap) m.metallic.reset();
}

} // namespace stromboli::obj
