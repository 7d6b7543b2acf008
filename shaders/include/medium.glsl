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

/// What is beyond the surface of a material, for what goes through it; outside: it comes from where the stored normal
/// points to.
uint mediumBehind(uint materialRow, uint here, bool outside) {
    const MediumBorder border = fetchBorder(materialRow);
    return border.isBorder == 0u ? here : (outside ? border.inside : border.outside);
}

/// Where a ray starts that leaves s towards w. What passes a surface that is no border starts on the side that it comes
/// from, so that it meets a border in the surface's plane, whichever of the two has been met first.
vec3 leaveThroughMedia(SurfacePoint s, vec3 w, bool transmitted) {
    vec3 origin = leave(s, w, transmitted);
    if (PASSES_BORDERS && transmitted && s.skipPrimitive != NO_PRIMITIVE && fetchBorder(s.material).isBorder == 0u)
        origin = s.position + offsetLength(s.error, s.geometric) * s.geometric;
    return origin;
}

/// Where light comes from that leaves s: `here`, or what is beyond s.
uint mediumBeyond(SurfacePoint s, Material m, uint here, bool transmitted) {
    if (HAS_MEDIA) return transmitted ? mediumBehind(s.material, here, s.outside) : here;
    if (!HAS_ABSORPTION || !transmitted || !boundsVolume(m)) return here;
    return s.outside ? s.material : NO_MEDIUM;
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
