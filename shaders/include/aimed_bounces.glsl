// Aimed bounces: a second density of bounces, besides the BSDF's own, to what lamps light from near by (docs/theory/
// estimator.md, "Aimed bounces"). The inside of a shade or of a housing is far brighter than the rest of a room, and few
// directions lead there. One diffuse bounce in eight goes to a point of it, by the one-sample balance heuristic (Veach
// and Guibas 1995), so that no weight is above 8 / 7. host/kernel/find_lit_cells.hpp finds the cells.

const float AIM_SHARE = 0.125; ///< of a surface's bounces

/// What is known of a bounce before it arrives, where its weight follows from what it meets.
struct Aim {
    uint place;    ///< that it aims at; a ray that ends elsewhere brings nothing. NO_PRIMITIVE: it follows the BSDF
    float bsdfPdf; ///< density of its direction by the BSDF alone; 0: its weight is known
};

const Aim NO_AIM = Aim(NO_PRIMITIVE, 0.0);

/// Whether bounces from surfaces with these lobes are mixed with those that aim.
bool aimsFrom(uint lobes) { return AIMS_BOUNCES && (lobes & DIFFUSE_LOBES) != 0u; }

uint componentOf(uvec4 row, uint index) {
    const uvec2 pair = index < 2u ? row.xy : row.zw;
    return (index & 1u) == 0u ? pair.x : pair.y;
}

LitCell litCell(uint number) {
    const uvec4 r = ROW(guideRows, number);
    return LitCell(uintBitsToFloat(r.x), r.y, r.z, uintBitsToFloat(r.w));
}

/// The cells of the triangle at a place.
struct CellsOfTriangle {
    bool exist;
    uint first, level;
};

CellsOfTriangle cellsAt(const Frame frame, uint place) {
    const uint number = componentOf(ROW(guideRows, frame.litCells + (place >> 2u)), place & 3u);
    return CellsOfTriangle(number != NO_CELLS, number >> CELLS_LEVEL_BITS, number & ((1u << CELLS_LEVEL_BITS) - 1u));
}

struct AimedPoint {
    uint place;
    vec3 position;
};

/// A point of the cells, by their density. u, each in [0, 1); x, a multiple of 2^-24, chooses the cell.
AimedPoint aimAtCell(const Frame frame, vec2 u) {
    ChoiceNumber choice = choiceNumber(u);
    uint column, fraction;
    umulExtended(choice.value << 1u, frame.litCells, column, fraction);
    const LitCell c = litCell(column);
    const bool own = float(int(fraction >> 8u)) * (1.0 / 16777216.0) < c.threshold;
    const uint number = own ? column : c.alias;
    vec2 v = vec2(float(int(newDigits(choice) >> 8u)) * (1.0 / 16777216.0), u.y);
    if (v.x + v.y > 1.0) v = 1.0 - v;
    const uint place = litCell(number).place;
    const CellsOfTriangle cells = cellsAt(frame, place);
    const uint cell = number - cells.first, square = cell >> 1u;
    const vec2 corner = vec2(float(square >> cells.level), float(square & ((1u << cells.level) - 1u)));
    const vec2 weights = ((cell & 1u) != 0u ? corner + 1.0 - v : corner + v) / float(1u << cells.level);
    const PlacedPrimitive p = fetchPlace(place);
    return AimedPoint(place, p.v0 + weights.x * (p.v1 - p.v0) + weights.y * (p.v2 - p.v0));
}

/// Density by area of what aims, at the hit of a ray.
float cellDensity(const Frame frame, uint place, vec2 weights) {
    const CellsOfTriangle cells = cellsAt(frame, place);
    const float side = float(1u << cells.level);
    const vec2 x = min(weights * side, vec2(side * (1.0 - 0.000244140625))); // as the host counts light (find_lit_cells.cpp, cellOf())
    const vec2 square = floor(x);
    const bool isUpper = (x.x - square.x) + (x.y - square.y) > 1.0;
    const uint cell = 2u * ((uint(square.x) << cells.level) + uint(square.y)) + (isUpper ? 1u : 0u);
    const float density = litCell(cells.exist ? cells.first + cell : 0u).density;
    return cells.exist ? density : 0.0;
}

/// What a bounce weighs that has arrived: its BSDF's density over that of both, or nothing.
float aimedWeight(const Frame frame, Aim aim, Traversal t, vec3 normal) {
    if (aim.bsdfPdf == 0.0) return 1.0;
    const bool hit = t.hitPrimitive != NO_PRIMITIVE;
    float pdf = 0.0;
    // In this order a product of tiny and huge lengths stays in range.
    if (hit) pdf = cellDensity(frame, t.hitPrimitive, vec2(t.b1, t.b2)) * t.tMax * t.tMax / max(abs(dot(normal, t.direction)), TINY);
    const bool isLost = aim.place != NO_PRIMITIVE && aim.place != t.hitPrimitive;
    return isLost ? 0.0 : 1.0 / ((1.0 - AIM_SHARE) + AIM_SHARE * (pdf / aim.bsdfPdf));
}

/// A direction from the BSDF, or to one of the cells. b.weight is that of the BSDF alone, f |cos| over its own density,
/// by which roulette goes; weight: what is known before it arrives of aimedWeight(), which comes on top.
BsdfSample sampleBsdfOrAim(const Frame frame, Material m, SurfacePoint s, vec3 u, out Aim aim, out float weight) {
    aim = NO_AIM;
    weight = 1.0;
    const bool mixes = aimsFrom(lobesOf(m)), aims = mixes && u.x < AIM_SHARE;
    if (mixes) {
        u.x = aims ? u.x / AIM_SHARE : (u.x - AIM_SHARE) / (1.0 - AIM_SHARE);
        // The number that chooses a lobe may be the first one.
        if (!takesThreeNumbers(lobesOf(m))) u.z = u.x;
    }
    BsdfSample b = sampleBsdf(m, s, u);
    if (!mixes) return b;
    const AimedPoint point = aimAtCell(frame, u.xy);
    const vec3 toPoint = unit(point.position - s.position);
    const BsdfValue f = evaluateBsdf(m, s, toPoint);
    if (aims) {
        b.direction = toPoint;
        b.weight = f.pdf > 0.0 ? f.value / f.pdf : vec3(0.0);
        b.pdf = f.pdf;
        b.lobe = isBehind(s, toPoint) ? LOBE_DIFFUSE_TRANSMISSION : LOBE_DIFFUSE_REFLECTION;
        aim.place = point.place;
    }
    if (isDelta(b.lobe)) weight = 1.0 / (1.0 - AIM_SHARE);
    else aim.bsdfPdf = b.pdf;
    return b;
}
