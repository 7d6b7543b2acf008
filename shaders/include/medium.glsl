// What rays go through (docs/theory/media.md). In scenes with media (MEDIA), surfaces say what is on their two sides.
// In others a volume may absorb: the inside of the surface that the path has entered last (docs/theory/estimator.md,
// "Volumes"). Scenes without either have nothing of this.

#include "shared/medium_types.h"

const bool HAS_MEDIA = MEDIA != 0u;
const bool HAS_ABSORPTION = (CLOSURES & (VOLUME_ABSORBS)) != 0u && !HAS_MEDIA;

/// Paths walk under surfaces, where nothing counts.
const bool WALKS = (MEDIA & MEDIA_UNDER_SURFACE) != 0u;
/// Borders without a material are met like all that has an opacity.
const bool PASSES_BORDERS = HAS_MEDIA && HAS_ALPHA;

bool mediaDo(uint bits) { return (MEDIA & bits) != 0u; }

MediumBorder fetchBorder(uint materialRow) {
    const uvec4 r = ROW(materialRows, materialRow - MEDIUM_BORDER_ROWS);
    return MediumBorder(r.x, r.y, r.z, r.w);
}

/// Whether a medium lies under a surface, so that what happens in it does not count.
bool isUnderSurface(uint medium) {
    const uint closures = ROW(materialRows, medium == NO_MEDIUM ? 0u : medium).w;
    return medium != NO_MEDIUM && (closures & LOBE_DELTA_REFLECTION) != 0u;
}

/// What a ray goes through. In scenes whose volumes overlap (MEDIA_OVERLAP) also the volumes that it is in, which say
/// what `medium` is, and what is around them.
struct Filling {
    uint medium;  ///< the first row of a material, or NO_MEDIUM
    uint volumes; ///< up to four numbers of volumes, a byte each, the largest first; 0: in none
    uint around;
};

Filling fillingOf(uint medium) { return Filling(medium, 0u, medium); }

/// How many of four bytes, the largest first, are at least that.
uint bytesFrom(uint bytes, uint least) {
    return ((bytes >> 24u) >= least ? 1u : 0u) + ((bytes >> 16u & 255u) >= least ? 1u : 0u) +
           ((bytes >> 8u & 255u) >= least ? 1u : 0u) + ((bytes & 255u) >= least ? 1u : 0u);
}

/// All bits of the bytes behind the first `count`, which are 4 at most.
uint bytesBehind(uint count) { return count > 3u ? 0u : 0xFFFFFFFFu >> (8u * count); }

/// A fifth volume takes the place of the smallest number.
uint withVolume(uint volumes, uint number) {
    const uint before = bytesFrom(volumes, number), rest = bytesBehind(before);
    return volumes & ~rest | (rest & ~(rest >> 8u)) & number * 0x01010101u | (volumes & rest) >> 8u;
}

/// Once less, if it is there.
uint withoutVolume(uint volumes, uint number) {
    const uint before = bytesFrom(volumes, number + 1u), rest = bytesBehind(before), after = bytesBehind(before + 1u);
    const bool isThere = bytesFrom(volumes, number) > before;
    return isThere ? volumes & ~rest | (volumes & after) << 8u : volumes;
}

/// What is beyond the border, for what goes through it; outside: it comes from where the stored normal points to. A volume
/// that has not been entered is left for what surrounds the scene.
Filling fillingBehind(MediumBorder border, Filling here, bool outside) {
    const uint behind = outside ? border.inside : border.outside;
    Filling filling = here;
    if (mediaDo(MEDIA_OVERLAP)) {
        const bool isVolume = border.isBorder == BORDER_OF_VOLUME;
        const uint number = border.volume & 255u, rows = border.volume >> 8u;
        const uint volumes = outside ? withVolume(here.volumes, number) : withoutVolume(here.volumes, number);
        const bool isLost = !outside && volumes == here.volumes;
        if (isVolume) filling.volumes = volumes;
        if (border.isBorder == BORDER_OF_MEDIA || isVolume && isLost) filling.around = behind;
        const uint top = filling.volumes >> 24u;
        if (isVolume) filling.medium = top == 0u ? filling.around : border.inside + top * rows - number * rows;
        else if (top == 0u) filling.medium = filling.around;
    } else if (border.isBorder != 0u) {
        filling.medium = behind;
    }
    return filling;
}

/// Where a ray starts that leaves s towards w. What passes a surface that is no border starts on the side that it comes
/// from, so that it meets a border in the surface's plane, whichever of the two has been met first.
vec3 leaveThroughMedia(SurfacePoint s, vec3 w, bool transmitted) {
    vec3 origin = leave(s, w, transmitted);
    if (PASSES_BORDERS && transmitted && s.skipPrimitive != NO_PRIMITIVE && fetchBorder(s.material).isBorder == 0u)
        origin = s.position + offsetLength(s.error, s.geometric) * s.geometric;
    return origin;
}

/// In scenes without media.
uint volumeBeyond(SurfacePoint s, Material m, uint here, bool transmitted) {
    if (!transmitted || !boundsVolume(m)) return here;
    return s.outside ? s.material : NO_MEDIUM;
}

/// Where light comes from that leaves s: `here`, or what is beyond s.
Filling fillingBeyond(SurfacePoint s, Material m, Filling here, bool transmitted) {
    Filling filling = here;
    if (HAS_MEDIA && transmitted) filling = fillingBehind(fetchBorder(s.material), here, s.outside);
    if (HAS_ABSORPTION) filling.medium = volumeBeyond(s, m, here.medium, transmitted);
    return filling;
}

/// The share of light that is left after that distance in a volume that absorbs (Beer and Lambert). Media are another
/// matter (media.glsl).
vec3 transmittance(uint medium, float distance) {
    if (!HAS_ABSORPTION) return vec3(1.0);
    const bool none = medium == NO_MEDIUM;
    const vec3 absorption =
        uintBitsToFloat(ROW(materialRows, none ? 0u : medium + PRINCIPLED_ABSORPTION_ROW).xyz);
    return none ? vec3(1.0) : exp(-absorption * distance);
}
