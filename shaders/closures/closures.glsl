// A material as one direction sees it: its closures with their weights, and the probabilities with which samples
// choose them. Recipes (stated.glsl, principled.glsl, burley.glsl) fill this in; all closures are evaluated together
// and samples have the density of all together (bsdf.glsl). Directions are unit vectors in the frame of the shading
// normal.

const bool SCENE_REFRACTS = (CLOSURES & (INTERFACE_REFRACTS)) != 0u;
const bool SCENE_TRANSMITS = (CLOSURES & (INTERFACE_REFRACTS | INTERFACE_IS_THIN)) != 0u;
const bool HAS_COAT = (CLOSURES & (CLOSURE_COAT)) != 0u;
/// Whether some base scatters to the other side in glTF's model.
const bool HAS_THROUGH = (CLOSURES & (LOBE_DIFFUSE_TRANSMISSION)) != 0u;
const bool HAS_SHEEN = (CLOSURES & (CLOSURE_SHEEN)) != 0u;
/// Bits of materials of which samples choose one of several closures.
const uint CHOSEN_CLOSURES = CLOSURE_LAYERS | CLOSURE_COAT | CLOSURE_SHEEN | LOBE_DIFFUSE_TRANSMISSION |
                             RECIPE_PRINCIPLED | RECIPE_BURLEY;
const bool SAMPLES_CHOOSE = (CLOSURES & (CHOSEN_CLOSURES)) != 0u;
/// Whether coats of some materials have normals of their own: DETAIL_COAT_HAS_NORMAL.
bool sceneHasCoatNormals() {
    const uint maps = 1u << TEXTURE_NORMAL | 1u << TEXTURE_CLEARCOAT_NORMAL;
    return HAS_COAT && sceneHas(RECIPE_PRINCIPLED) && (TEXTURE_SLOTS & maps) != 0u;
}

/// Where light comes from, as a material sees it. wo: unit, in the frame of the shading normal, whose z axis
/// is on the side of wo (without FACES_FORWARD on either); entering: wo is outside of what the
/// surface bounds.
struct Incidence {
    vec3 wo;
    bool entering;
    vec3 coat; ///< unit; the clear coat's normal, in the same frame
};

/// What the interface of glTF's model is made of.
struct PrincipledInterface {
    float metallic, transmission; ///< transmission: of the dielectric
    vec3 baseColor;
    vec3 f0; ///< of the dielectric
    float f90;
    float index;  ///< inside over outside
    float spread; ///< half of what blue light's index has more than red light's
    bool isInside; ///< of the volume
    float film;    ///< strength of interference in a thin film
    float filmIor, filmThickness; ///< nanometres
    float albedo; ///< ggxAlbedo() of the microfacets
    vec3 given, givenMetal; ///< under a film, reflectances by which light that facets scatter again is given back
};

/// What the interface and the base of Burley's model are made of.
struct BurleyInterface {
    bool isInside; ///< of a volume: only its interface is seen
    float clear;   ///< weight of the interface without a base
    vec3 tint;     ///< hue of the base colour
};

struct Closures {
    vec3 wo;
    float eta;        ///< index on the side of wo over that on the other
    bool isSmooth;    ///< the interface is a plane
    bool isThin;      ///< what is transmitted goes straight through
    FacetShape facets;
    FacetShape thinFacets; ///< of what a sheet of Burley's model transmits
    vec2 grain;            ///< cosine and sine of the angle from the tangent to the facets' first direction
    float interfaceWeight; ///< what the layers above leave to the interface
    vec3 diffuse;          ///< albedo of the base, times what reaches it and leaves it towards wo
    vec3 through;          ///< the same of diffuse transmission
    vec3 sheen;
    float sheenAlpha;
    float coat; ///< weight
    float coatAlpha;
    vec3 coatNormal;
    float diffuseShare, throughShare, sheenShare, coatShare; ///< probabilities; the rest is the interface's
    PrincipledInterface principled;
    BurleyInterface burley;
};

float interfaceShare(Closures c) { return max(1.0 - c.diffuseShare - c.throughShare - c.sheenShare - c.coatShare, 0.0); }

/// What the interface does with light at one of its facets, or the plane.
struct InterfaceLight {
    vec3 reflected, transmitted;
    float cosTransmitted; ///< 0 in total reflection
    float reflects;       ///< probability with which samples are reflected
};

/// The frame of the facets, x along the direction of the first alpha, and back.
vec3 alongGrain(Closures c, vec3 w) {
    if (!sceneHas(FACETS_ARE_TURNED)) return w;
    return vec3(c.grain.x * w.x + c.grain.y * w.y, c.grain.x * w.y - c.grain.y * w.x, w.z);
}
vec3 acrossGrain(Closures c, vec3 w) {
    if (!sceneHas(FACETS_ARE_TURNED)) return w;
    return vec3(c.grain.x * w.x - c.grain.y * w.y, c.grain.x * w.y + c.grain.y * w.x, w.z);
}

/// To the frame of the coat's normal, and back.
vec3 toCoat(Closures c, vec3 w) { return sceneHasCoatNormals() ? toLocal(makeFrame(c.coatNormal), w) : w; }
vec3 fromCoat(Closures c, vec3 w) { return sceneHasCoatNormals() ? toWorld(makeFrame(c.coatNormal), w) : w; }
