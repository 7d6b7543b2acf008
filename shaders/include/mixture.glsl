// Mixtures of materials (docs/theory/estimator.md, "Mixtures"). A path meets one material of a mixture, drawn once at
// each hit, which bounces are sampled from. Where all materials of it scatter in one frame and leave light in one medium,
// values and densities are those of all: only the choice of the direction is by chance.

#include "include/pass_number.glsl"

/// One of the two that a mixture is of: another material, or else its own.
struct Blend {
    uint other;   ///< the first row of the other material; its own, where it is no mixture
    float share;  ///< of cases in which that one is met
    uint others;  ///< beside any one of the mixture's materials, where all are evaluated together; else 0
    uint lobes;   ///< of all, where there are others
};

/// OTHER_ of no side.
const uint NOT_THERE_NOWHERE = OTHER_MASK;

/// What a material is a mixture of. materialRow: its first; notThere: OTHER_ of the side that the surface is not seen
/// from.
Blend blendAt(uint materialRow, PointAttributes a, uint notThere) {
    const MaterialDetail detail = fetchDetail(materialRow);
    const uvec4 r = ROW(materialRows, textureUseRow(materialRow, bundles() + looseTexturesOf(detail)));
    const bool isBlend = (detail.flags & DETAIL_IS_BLEND) != 0u;
    const BlendRow blend = BlendRow(r.x, uintBitsToFloat(r.y), isBlend ? r.z : 0u, isBlend ? r.w : 0u);
    float share = isBlend && (blend.place & OTHER_MASK) != notThere ? blend.share : 0.0;
    if (sceneHasSlot(TEXTURE_BLEND_SHARE)) {
        const TextureUse t = fetchTextureUse(materialRow, blend.texture);
        const float texel = lookUp(t, coordinatesOf(t, a)).r;
        share *= blend.texture != 0u ? texel : 1.0;
    }
    return Blend(isBlend ? blend.other : materialRow, min(share, 1.0),
                 blend.place >> BLEND_OTHERS_SHIFT & BLEND_OTHERS_MASK, blend.place >> BLEND_LOBES_SHIFT);
}

/// OTHER_ of the side that a surface, its normals as stored, is not seen from.
uint sideNotSeen(SurfacePoint s) { return isSeenFromBehind(s) ? OTHER_IN_FRONT : OTHER_BEHIND; }

/// The material of the side that a surface is seen from, for those who draw none of a mixture.
uint materialOfSide(SurfacePoint s) {
    const MaterialDetail detail = fetchDetail(s.material);
    const uvec4 r = ROW(materialRows, textureUseRow(s.material, bundles() + looseTexturesOf(detail)));
    const uint place = r.w & OTHER_MASK;
    const bool hasOther = (detail.flags & DETAIL_IS_BLEND) != 0u && place != OTHER_BY_SHARE && place != sideNotSeen(s);
    return hasOther ? r.x : s.material;
}

/// Draws the material that a path meets at a hit, by hitWords(), once for its light samples and its bounce. s: not yet faced
/// forward.
void drawMaterial(inout SurfacePoint s, uvec4 words) {
    const PointAttributes a = attributesOf(s);
    const uint notThere = sideNotSeen(s);
    bool goesOn = true;
    uint i = 0u;
    do {
        const Blend blend = blendAt(s.material, a, notThere);
        if (MOST_OTHERS > 0u && s.mixture == NO_MIXTURE && blend.others > 0u) s.mixture = s.material;
        ++i;
        goesOn = hitNumber(words, i) < blend.share;
        s.material = goesOn ? blend.other : s.material;
    } while (goesOn && i < MOST_BLENDS);
}

/// The material drawn at a surface, as the mixture that it is of scatters: with the lobes of all.
Material inMixture(Material m, SurfacePoint s) {
    if (MOST_OTHERS == 0u) return m;
    const bool isMixed = s.mixture != NO_MIXTURE;
    const uint row = isMixed ? s.mixture : s.material;
    const MaterialDetail detail = fetchDetail(row);
    const uint place = ROW(materialRows, textureUseRow(row, bundles() + looseTexturesOf(detail))).w;
    m.header.w |= isMixed ? place >> BLEND_LOBES_SHIFT & LOBE_MASK : 0u;
    return m;
}

/// What the materials of a mixture beside the drawn one send from wi to wo, times their shares.
struct OtherMaterials {
    BsdfValue sum;
    float share; ///< of all of them
};

/// s: faced forward, with the material drawn. Each pass of the loop takes one material of the mixture; of two there is one
/// pass, for the other. All is called in one place: the module holds each call anew.
OtherMaterials evaluateOthers(SurfacePoint s, vec3 wi) {
    OtherMaterials o = OtherMaterials(NO_SCATTERING, 0.0);
    if (MOST_OTHERS == 0u) return o;
    const PointAttributes a = attributesOf(s);
    const bool isMixed = s.mixture != NO_MIXTURE;
    MaterialPoint point = materialPoint(s);
    uint row = isMixed ? s.mixture : s.material, others = 0u;
    float left = 1.0;
    uint i = 0u;
    do {
        const Blend blend = blendAt(row, a, NOT_THERE_NOWHERE);
        if (i == 0u && isMixed) others = blend.others;
        const bool isFirstOfTwo = MOST_OTHERS == 1u && row == s.material;
        point.material = isFirstOfTwo ? blend.other : row;
        if (isMixed && i <= others && point.material != s.material) {
            const float share = left * (isFirstOfTwo ? blend.share : 1.0 - blend.share);
            const BsdfValue f = evaluateBsdf(lookUpMaterial(point).parameters, s, wi);
            o.sum.value += share * f.value;
            o.sum.pdf += share * f.pdf;
            o.share += share;
        }
        left *= blend.share;
        row = blend.other;
        ++i;
    } while (MOST_OTHERS > 1u && i <= others);
    return o;
}

/// As evaluateBsdf() has it, of all materials of the mixture; m is the drawn one.
BsdfValue evaluateMixture(Material m, SurfacePoint s, vec3 wi) {
    BsdfValue f = evaluateBsdf(m, s, wi);
    if (MOST_OTHERS == 0u) return f;
    const OtherMaterials o = evaluateOthers(s, wi);
    const float own = 1.0 - o.share;
    return BsdfValue(own * f.value + o.sum.value, own * f.pdf + o.sum.pdf);
}

/// A sample of the drawn material, as one of the mixture: with the density of all, unless it is of a delta lobe, whose
/// share is that of its draw.
BsdfSample ofMixture(BsdfSample b, SurfacePoint s) {
    if (MOST_OTHERS == 0u) return b;
    const OtherMaterials o = evaluateOthers(s, b.direction);
    if (s.mixture == NO_MIXTURE || isDelta(b.lobe)) return b;
    const float own = (1.0 - o.share) * b.pdf, pdf = own + o.sum.pdf;
    // What is lost has no density of its own.
    b.weight = b.pdf > 0.0 ? (own * b.weight + o.sum.value) / max(pdf, TINY) : vec3(0.0);
    b.pdf = pdf;
    return b;
}
