#include "scene/model/mixture.hpp"

#include "scene/model/surface_lookup.hpp"

#include <algorithm>

namespace stromboli {
namespace {

bool sameUse(const TextureUse* a, const TextureUse* b) {
    if (!a || !b) return a == b;
    return a->texture == b->texture && a->uvSet == b->uvSet && a->uRow == b->uRow &&
           a->vRow == b->vRow && a->scale == b->scale;
}

/// The clear coat has its own normal beside maps.
bool mayHaveCoatNormal(const Material& m) {
    return m.kind == MaterialKind::Principled && m.principled.clearcoat > 0 &&
           (textureIn(m, TextureSlot::Normal) || textureIn(m, TextureSlot::ClearcoatNormal));
}

bool boundsVolume(const Material& m) {
    return m.boundsMedia || (m.kind == MaterialKind::Principled && m.entersVolume());
}

/// Heights bend the normals of diffuse surfaces in another way than those of others.
bool haveOneNormal(const Material& a, const Material& b) {
    const TextureUse* heights = textureIn(a, TextureSlot::Height);
    return a.reliefRule == b.reliefRule && a.reliefShadows == b.reliefShadows &&
           a.isBlackBehind == b.isBlackBehind && a.mirrorsReliefBehind == b.mirrorsReliefBehind &&
           sameUse(heights, textureIn(b, TextureSlot::Height)) &&
           sameUse(textureIn(a, TextureSlot::Normal), textureIn(b, TextureSlot::Normal)) &&
           (!heights || (a.kind == MaterialKind::Diffuse) == (b.kind == MaterialKind::Diffuse));
}

} // namespace

std::vector<uint32_t> materialsOfMixture(std::span<const Material> materials, uint32_t first) {
    std::vector<uint32_t> mixture{first};
    while (mixture.size() < kMostOfAMixture) {
        const Material& last = materials[mixture.back()];
        if (last.other == kNoMaterial || last.otherShare <= 0) break;
        mixture.push_back(last.other);
    }
    return mixture;
}

bool areEvaluatedTogether(std::span<const Material> materials, std::span<const uint32_t> mixture) {
    if (mixture.size() < 2) return false;
    return std::ranges::all_of(mixture, [&](uint32_t i) {
        const Material& m = materials[i];
        const bool isByShare = i == mixture.back() || m.otherPlace == OtherPlace::ByShare;
        return isByShare && !mayHaveCoatNormal(m) && !boundsVolume(m) &&
               haveOneNormal(materials[mixture.front()], m);
    });
}

} // namespace stromboli
