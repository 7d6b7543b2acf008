// Only what a scene needs: the host sets these when it makes the pipeline, the compiler removes
// what they switch off (host/kernel/kernel_features.hpp decides them).
layout(local_size_x_id = SPEC_WORKGROUP_SIZE) in;
layout(constant_id = SPEC_TRAVERSAL_STEPS) const uint TRAVERSAL_STEPS = 8u;
layout(constant_id = SPEC_STACK_SIZE) const uint STACK_SIZE = 64u;
layout(constant_id = SPEC_STACK_IN_REGISTERS) const bool STACK_IN_REGISTERS = false;
layout(constant_id = SPEC_HAS_TRIANGLES) const bool HAS_TRIANGLES = true;
layout(constant_id = SPEC_HAS_SPHERES) const bool HAS_SPHERES = true;
layout(constant_id = SPEC_HAS_NORMALS) const bool HAS_NORMALS = true;
layout(constant_id = SPEC_BSDF_KINDS) const uint BSDF_KINDS = 31u;
layout(constant_id = SPEC_HAS_EMISSION) const bool HAS_EMISSION = true;
layout(constant_id = SPEC_LIGHT_KINDS) const uint LIGHT_KINDS = 255u;
layout(constant_id = SPEC_ROULETTE) const uint ROULETTE = ROULETTE_THROUGHPUT;
layout(constant_id = SPEC_ROULETTE_START) const uint ROULETTE_START = 3u;
layout(constant_id = SPEC_ORTHOGRAPHIC) const bool ORTHOGRAPHIC = false;
layout(constant_id = SPEC_CLIP_ALONG_RAY) const bool CLIP_ALONG_RAY = false;
layout(constant_id = SPEC_LIGHT_GROUPS) const uint LIGHT_GROUPS = 7u;
layout(constant_id = SPEC_LIGHT_SAMPLES) const uint LIGHT_SAMPLES = 1u;
layout(constant_id = SPEC_SAMPLER) const uint SAMPLER = SAMPLER_INDEPENDENT;
layout(constant_id = SPEC_LIGHT_NUMBERS) const uint LIGHT_NUMBERS = LIGHT_NUMBERS_FIRST;
layout(constant_id = SPEC_MIS_LOBES) const uint MIS_LOBES = 0u;
layout(constant_id = SPEC_HAS_AMBIENT) const bool HAS_AMBIENT = true;
layout(constant_id = SPEC_AMBIENT_BY_BOUNCES) const bool AMBIENT_BY_BOUNCES = false;
layout(constant_id = SPEC_SPLITS) const bool SPLITS = false;
layout(constant_id = SPEC_BLACK_BACKS) const bool BLACK_BACKS = false;
layout(constant_id = SPEC_GAP_PROPOSAL) const bool GAP_PROPOSAL = false;

// The kernel is compiled into several modules, of which the host takes the smallest that has all a picture needs
// (host/kernel/kernel_modules.cpp): a driver reads the whole module before it knows what the constants switch off,
// and that is most of a start.
layout(constant_id = SPEC_LARGE_TREE) const bool LARGE_TREE = false;
layout(constant_id = SPEC_INTEGRATOR) const uint INTEGRATOR = INTEGRATOR_PATH;
layout(constant_id = SPEC_DIRECT_LIGHT) const uint DIRECT_LIGHT = DIRECT_LIGHTS;
layout(constant_id = SPEC_CS184) const bool CS184 = false;
layout(constant_id = SPEC_COUNT_STEPS) const bool COUNT_STEPS = false;
layout(constant_id = SPEC_HAS_ENVIRONMENT) const bool HAS_ENVIRONMENT = true;
layout(constant_id = SPEC_HAS_BACKDROP) const bool HAS_BACKDROP = true;
layout(constant_id = SPEC_HAS_LENS) const bool HAS_LENS = false;
layout(constant_id = SPEC_PIXEL_FILTER) const uint PIXEL_FILTER = FILTER_BOX;
layout(constant_id = SPEC_FILTER_EXTRA) const float FILTER_EXTRA = 0.0;
layout(constant_id = SPEC_LIGHT_CHOICE) const uint LIGHT_CHOICE = LIGHT_CHOICE_TREE;

// RICH_MATERIALS: modules that have what few scenes have and whose code is large. Scenes without it take the others.
layout(constant_id = SPEC_PRINCIPLED_FEATURES) const uint PRINCIPLED_FEATURES = 63u;
layout(constant_id = SPEC_TEXTURE_SLOTS) const uint TEXTURE_SLOTS = 0u;
layout(constant_id = SPEC_LOOSE_SLOTS) const uint LOOSE_SLOTS = 0u;
layout(constant_id = SPEC_LOOSE_TEXTURES) const uint LOOSE_TEXTURES = 255u;
layout(constant_id = SPEC_CORNER_NORMALS) const bool CORNER_NORMALS = true;
layout(constant_id = SPEC_WAITING_PART) const uint WAITING_PART = 0u;
layout(constant_id = SPEC_TEXEL_KINDS) const uint TEXEL_KINDS = 8191u;
layout(constant_id = SPEC_ATTRIBUTES) const uint ATTRIBUTES = 0u;
layout(constant_id = SPEC_ALPHA) const bool HAS_ALPHA = false;
layout(constant_id = SPEC_TANGENT_FRAMES) const bool TANGENT_FRAMES = false;
layout(constant_id = SPEC_BLENDS) const bool HAS_BLENDS = false;
layout(constant_id = SPEC_RELIEF_RULES) const bool RELIEF_RULES = false;
layout(constant_id = SPEC_HIDES_SURFACES) const bool HIDES_SURFACES = false;
layout(constant_id = SPEC_FLAT_TERMINATOR) const bool FLAT_TERMINATOR = false;

// FACET_MATERIALS: those of these modules that have conductors, rough dielectrics, thin ones and plastic.
layout(constant_id = SPEC_FACETS) const uint FACETS = 63u;

// PLACEMENTS: those of these modules in which prototypes can be placed. Trees have groups of two words there.
layout(constant_id = SPEC_HAS_PLACEMENTS) const bool HAS_PLACEMENTS = false;
layout(constant_id = SPEC_TRAVERSAL_LEGS) const uint TRAVERSAL_LEGS = 1u;

/// Whether triangles have normals of their corners. Without these and without maps there is no shading normal
/// beside the geometric one (HAS_NORMALS).
const bool HAS_CORNER_NORMALS = HAS_NORMALS && CORNER_NORMALS;
/// Whether lanes at surfaces wait for each other (docs/kernel.md, "Surfaces that wait").
const bool SURFACES_WAIT = WAITING_PART != 0u;
/// Whether samples have weights by their place about the pixel, some of them negative.
bool samplesHaveWeights() { return PIXEL_FILTER == FILTER_TABLE; }
bool sceneHasBsdf(uint kind) { return (BSDF_KINDS & (1u << kind)) != 0u; }
/// Kinds that only these modules have.
bool sceneHasFacetMaterials() { return BSDF_KINDS >= 1u << BSDF_CONDUCTOR; }
/// Whether light samples go to lights of this kind.
bool samplesLightKind(uint kind) { return (LIGHT_KINDS & (1u << kind)) != 0u; }
/// kind == wanted, known without looking where there is but one, or none of that kind.
bool isLight(uint kind, uint wanted) {
    return samplesLightKind(wanted) && (LIGHT_KINDS == 1u << wanted || kind == wanted);
}
