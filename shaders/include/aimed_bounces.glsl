// Aimed bounces: a second density of bounces, besides the BSDF's own, to what lamps light from near by (docs/theory/
// estimator.md, "Aimed bounces"): the insides of shades and housings, which are far brighter than the rest of a room, and
// glass about lamps, through which light samples do not pass. Few directions lead there. One bounce in eight goes to a point
// of them, by the one-sample balance heuristic (Veach and Guibas 1995), so that no weight is above 8 / 7.
// host/kernel/find_lit_cells.hpp finds the cells.

const float AIM_SHARE = 0.125; ///< of a surface's bounces

/// What is known of a bounce before it arrives, where its weight follows from what it meets.
struct Aim {
    uint place;    ///< that it aims at; a ray that ends elsewhere brings nothing. NO_PRIMITIVE: it follows the BSDF
    float bsdfPdf; ///< density of its direction by the BSDF alone; 0: its weight is known
    float weight;  ///< of the bounces since the last surface that aims, which says nothing of the light that is to come
};

const Aim NO_AIM = Aim(NO_PRIMITIVE, 0.0, 1.0);

/// Whether bounces from a surface of this material are mixed with those that aim: where it scatters light from all sides,
/// and lets none through.
bool aimsFrom(Material m) {
    return AIMS_BOUNCES && hasClosure(m, CLOSURE_BASE) && (lobesOf(m) & LOBE_GLOSSY_TRANSMISSION) == 0u;
}

LitCell litCell(uint number) {
    const uvec4 r = ROW(guideRows, number);
    return LitCell(uintBitsToFloat(r.x), r.y, r.z, uintBitsToFloat(r.w));
}

/// The cells of the primitive at a place.
struct CellsOfPlace {
    bool exist;
    uint first, level;
};

CellsOfPlace cellsAt(const Frame frame, uint place) {
    const uint number = componentOf(ROW(guideRows, frame.litCells + (place >> 2u)), place & 3u);
    return CellsOfPlace(number != NO_CELLS, number >> CELLS_LEVEL_BITS, number & ((1u << CELLS_LEVEL_BITS) - 1u));
}

/// 1 - cos of the half angle that a sphere is seen in; 0 from within.
float coneOfSphere(vec3 toCenter, float radius) {
    const float sin2 = radius * radius / dot(toCenter, toCenter);
    return sin2 < 1.0 ? sin2 / (1.0 + sqrt(1.0 - sin2)) : 0.0;
}

/// A direction in a cone about `axis`, uniform by solid angle. cone: 1 - cos of its half angle.
vec3 sampleCone(vec3 axis, float cone, vec2 u) {
    const float below = u.x * cone, sine = sqrt(below * (2.0 - below));
    return toWorld(makeFrame(axis), vec3(sine * cosSin(4.0 * u.y), 1.0 - below));
}

/// Where a bounce goes that aims.
struct AimedAt {
    uint place;
    vec3 direction; ///< unit
};

/// From a point to one of the cells, by their density. u, each in [0, 1): multiples of 2^-24.
AimedAt aimAtCell(const Frame frame, vec3 from, vec2 u) {
    ChoiceNumber choice = choiceNumber(u);
    uint fraction;
    float rest;
    const uint column = pickColumn(choice, frame.litCells, fraction);
    const LitCell c = litCell(column);
    const uint number = choosesAlias(choice, fraction, c.threshold, rest) ? c.alias : column;
    const uint place = litCell(number).place;
    const CellsOfPlace cells = cellsAt(frame, place);
    const uint cell = number - cells.first, square = cell >> 1u;
    const bool isBeyond = rest + u.y > 1.0; // the diagonal
    const vec2 v = isBeyond ? 1.0 - vec2(rest, u.y) : vec2(rest, u.y);
    const vec2 corner = vec2(float(square >> cells.level), float(square & ((1u << cells.level) - 1u)));
    const vec2 weights = ((cell & 1u) != 0u ? corner + 1.0 - v : corner + v) / float(1u << cells.level);
    const PlacedPrimitive p = fetchPlace(place);
    vec3 toPoint = p.v0 - from;
    const float cone = HAS_SPHERES && p.isSphere ? coneOfSphere(toPoint, p.radius) : 0.0;
    if (!(HAS_SPHERES && p.isSphere)) toPoint += weights.x * (p.v1 - p.v0) + weights.y * (p.v2 - p.v0);
    AimedAt at = AimedAt(place, unit(toPoint));
    if (HAS_SPHERES && p.isSphere) at.direction = sampleCone(at.direction, cone, vec2(rest, u.y));
    return at;
}

/// Density by solid angle of what aims, in the direction of a ray that has met something. normal: unit, of that.
float aimedPdf(const Frame frame, Traversal t, vec3 normal) {
    const CellsOfPlace cells = cellsAt(frame, t.hitPrimitive);
    const float density = litCell(cells.exist ? cells.first + cellOfWeights(t.b1, t.b2, cells.level) : 0u).density;
    if (!cells.exist) return 0.0;
    // In this order a product of tiny and huge lengths stays in range.
    float pdf = density * t.tMax * t.tMax / max(abs(dot(normal, t.direction)), TINY);
    if (HAS_SPHERES) {
        const PlacedPrimitive p = fetchPlace(t.hitPrimitive);
        const float cone = coneOfSphere(p.v0 - t.origin, p.radius);
        if (p.isSphere) pdf = cone > 0.0 ? density / (2.0 * PI * cone) : 0.0;
    }
    return pdf;
}

/// What a bounce weighs that has arrived: its BSDF's density over that of both, or nothing.
float aimedWeight(const Frame frame, Aim aim, Traversal t, vec3 normal) {
    if (aim.bsdfPdf == 0.0) return 1.0;
    const float pdf = t.hitPrimitive != NO_PRIMITIVE ? aimedPdf(frame, t, normal) : 0.0;
    const bool isLost = aim.place != NO_PRIMITIVE && aim.place != t.hitPrimitive;
    return isLost ? 0.0 : 1.0 / ((1.0 - AIM_SHARE) + AIM_SHARE * (pdf / aim.bsdfPdf));
}

/// By what roulette goes: the throughput without the weights of aimed bounces that have arrived where more of them go
/// than the BSDF sends, as more light comes from there. From the next surface that aims on, they count.
float throughputForRoulette(inout Aim aim, Material m, float throughput) {
    if (aimsFrom(m)) aim.weight = 1.0;
    return throughput / aim.weight;
}

/// A direction from the BSDF, or to one of the cells. b.weight is that of the BSDF alone, f |cos| over its own density,
/// by which roulette goes; weight: what is known before it arrives of aimedWeight(), which comes on top. aim: but for its
/// weight, of this bounce.
BsdfSample sampleBsdfOrAim(const Frame frame, Material m, SurfacePoint s, vec3 u, inout Aim aim, out float weight) {
    aim.place = NO_PRIMITIVE;
    aim.bsdfPdf = 0.0;
    weight = 1.0;
    const bool mixes = aimsFrom(m), aims = mixes && u.x < AIM_SHARE;
    if (mixes) {
        u.x = aims ? u.x / AIM_SHARE : (u.x - AIM_SHARE) / (1.0 - AIM_SHARE);
        // The number that chooses a lobe may be the first one.
        if (!takesThreeNumbers(lobesOf(m))) u.z = u.x;
    }
    BsdfSample b = sampleBsdf(m, s, u);
    if (!mixes) return b;
    const AimedAt at = aimAtCell(frame, s.position, u.xy);
    const BsdfValue f = evaluateBsdf(m, s, at.direction);
    if (aims) {
        const bool isGlossy = (lobesOf(m) & GLOSSY_LOBES) != 0u; // as sampleLocally() names lobes
        b.direction = at.direction;
        b.weight = f.pdf > 0.0 ? f.value / f.pdf : vec3(0.0);
        b.pdf = f.pdf;
        b.lobe = isGlossy ? LOBE_GLOSSY_REFLECTION : LOBE_DIFFUSE_REFLECTION;
        if (isBehind(s, at.direction)) b.lobe = LOBE_DIFFUSE_TRANSMISSION;
        aim.place = at.place;
    }
    if (isDelta(b.lobe)) weight = 1.0 / (1.0 - AIM_SHARE);
    else aim.bsdfPdf = b.pdf;
    return b;
}
