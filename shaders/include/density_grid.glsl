// Media whose density varies: tentative collisions at a rate that bounds the extinction in a block of the grid, each real
// with the probability that the density says (Woodcock et al. 1965), from block to block. Collisions are decided for three
// channels together, by what they carry, so that weights stay bounded (Kutz, Habel, Li and Novak 2017). A ray to a light
// takes what null collisions leave (ratio tracking; Novak, Selle and Jarosz 2014).

GridHeader fetchGrid(uint row) {
    const uvec4 a = ROW(materialRows, row + 3u), b = ROW(materialRows, row + 4u);
    return GridHeader(uintBitsToFloat(ROW(materialRows, row)), uintBitsToFloat(ROW(materialRows, row + 1u)),
                      uintBitsToFloat(ROW(materialRows, row + 2u)), a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}

/// p: in the unit cube.
float densityAt(GridHeader g, vec3 p) {
    const vec3 most = vec3(g.sizeX - 1u, g.sizeY - 1u, g.sizeZ - 1u);
    const vec3 x = clamp(p * (most + 1.0) - 0.5, vec3(0.0), most), low = floor(x), part = x - low;
    const uint layer = g.sizeX * g.sizeY, upper = low.z < most.z ? layer : 0u;
    const uint row = g.values + uint(low.x) + g.sizeX * uint(low.y) + layer * uint(low.z);
    const vec4 corners = mix(uintBitsToFloat(ROW(materialRows, row)), uintBitsToFloat(ROW(materialRows, row + upper)), part.z);
    const vec2 along = mix(corners.xz, corners.yw, part.x);
    return mix(along.x, along.y, part.y);
}

/// p: in the unit cube, outside of which the outermost values go on.
vec3 colorOfCells(uvec3 size, uint values, vec3 p) {
    const vec3 most = vec3(size - 1u);
    const vec3 x = clamp(p * (most + 1.0) - 0.5, vec3(0.0), most), low = floor(x), part = x - low;
    const uvec3 strides = uvec3(1u, size.x, size.x * size.y), first = uvec3(low) * strides;
    const uint row = values + first.x + first.y + first.z;
    const uvec3 next = mix(uvec3(0u), strides, lessThan(low, most));
#define CELL(offset) uintBitsToFloat(ROW(materialRows, row + (offset))).xyz
    const vec3 lower = mix(mix(CELL(0u), CELL(next.x), part.x), mix(CELL(next.y), CELL(next.x + next.y), part.x), part.y);
    const vec3 upper = mix(mix(CELL(next.z), CELL(next.x + next.z), part.x),
                           mix(CELL(next.y + next.z), CELL(next.x + next.y + next.z), part.x), part.y);
#undef CELL
    return mix(lower, upper, part.z);
}

/// header: the row of a ColorGridHeader.
vec3 colorAt(uint header, vec3 world) {
    const vec4 a = uintBitsToFloat(ROW(materialRows, header)), b = uintBitsToFloat(ROW(materialRows, header + 1u)),
               c = uintBitsToFloat(ROW(materialRows, header + 2u));
    const uvec4 cells = ROW(materialRows, header + 3u);
    return colorOfCells(cells.xyz, cells.w, vec3(dot(a.xyz, world) + a.w, dot(b.xyz, world) + b.w, dot(c.xyz, world) + c.w));
}

/// header: the row of a GlowHeader.
vec3 glowAt(uint header, float kelvins) {
    const uvec4 r = ROW(materialRows, header);
    const vec3 range = uintBitsToFloat(r.xyz);
    const float last = uintBitsToFloat(ROW(materialRows, header + 1u).x);
    const float x = clamp((1.0 / kelvins - range.y) * range.z, 0.0, last), low = min(floor(x), last - 1.0);
    const uint row = r.w + uint(low);
    const vec4 v = mix(uintBitsToFloat(ROW(materialRows, row)), uintBitsToFloat(ROW(materialRows, row + 1u)), x - low);
    return kelvins < range.x ? vec3(0.0) : v.xyz * exp(v.w);
}

MediumTints fetchTints(uint medium) {
    const uvec4 r = ROW(materialRows, medium + MEDIUM_TINTS_ROW);
    return MediumTints(r.x, r.y, r.z, r.w);
}

/// What a medium does at a place, per metre.
struct MediumPoint {
    vec3 extinction, scattering, emission;
};

/// p: the place in the cube of the medium's grid. medium: its first row.
MediumPoint mediumPoint(MediumBody m, GridHeader g, uint medium, vec3 p, vec3 world) {
    MediumTints tints = MediumTints(0u, 0u, 0u, 0u);
    if (mediaDo(MEDIA_VARY_EXTINCTION | MEDIA_VARY_SCATTERING | MEDIA_VARY_SOURCE)) tints = fetchTints(medium);
    vec3 factor = vec3(densityAt(g, p));
    if (mediaDo(MEDIA_VARY_EXTINCTION) && (tints.kinds & TINT_EXTINCTION) != 0u)
        factor = colorOfCells(uvec3(g.sizeX, g.sizeY, g.sizeZ), g.values, p);
    MediumPoint point;
    point.extinction = m.extinction * factor;
    point.scattering = point.extinction * m.albedo;
    if (mediaDo(MEDIA_VARY_SCATTERING) && tints.scattering != 0u) {
        const bool isFactor = (tints.kinds & TINT_SCATTERING_IS_FACTOR) != 0u;
        point.scattering = min(colorAt(tints.scattering, world) * (isFactor ? m.extinction : point.extinction), point.extinction);
    }
    point.emission = m.emission * factor;
    if (mediaDo(MEDIA_VARY_SOURCE) && tints.source != 0u) {
        vec3 light = colorAt(tints.source, world);
        if (mediaDo(MEDIA_GLOW) && tints.glow != 0u) light = light.x * glowAt(tints.glow, light.y);
        point.emission = (point.extinction - point.scattering) * light;
    }
    return point;
}

float boundOfBlock(GridHeader g, ivec3 block) {
    const uint index = uint(block.x) + g.blocksX * (uint(block.y) + g.blocksY * uint(block.z));
    const uvec4 r = ROW(materialRows, g.bounds + (index >> 2u));
    const uint place = index & 3u;
    return uintBitsToFloat(place == 0u ? r.x : (place == 1u ? r.y : (place == 2u ? r.z : r.w)));
}

/// A ray in the unit cube of a grid; distances along it are the world's.
struct GridRay {
    vec3 origin, direction;
    float from, to; ///< the part within the cube; to <= from: none
};

/// The stretch of the ray from its tMin to its tMax.
GridRay intoGrid(GridHeader g, Traversal ray, float perLength) {
    GridRay r;
    const vec3 d = ray.direction * perLength;
    r.origin = vec3(dot(g.toUnit0.xyz, ray.origin) + g.toUnit0.w, dot(g.toUnit1.xyz, ray.origin) + g.toUnit1.w,
                    dot(g.toUnit2.xyz, ray.origin) + g.toUnit2.w);
    r.direction = vec3(dot(g.toUnit0.xyz, d), dot(g.toUnit1.xyz, d), dot(g.toUnit2.xyz, d));
    r.from = ray.tMin / perLength;
    r.to = ray.tMax / perLength;
    for (int axis = 0; axis < 3; ++axis) {
        const float o = r.origin[axis], v = r.direction[axis];
        const float toLow = -o / v, toHigh = (1.0 - o) / v;
        const bool isParallel = v == 0.0;
        if (isParallel && (o < 0.0 || o > 1.0)) r.to = r.from;
        if (!isParallel) {
            r.from = max(r.from, min(toLow, toHigh));
            r.to = min(r.to, max(toLow, toHigh));
        }
    }
    return r;
}

/// The distance at which the ray leaves a block, and along which axis.
float endOfBlock(GridRay r, ivec3 block, vec3 blocks, out int axis) {
    float end = INFINITE_DISTANCE;
    axis = 0;
    for (int i = 0; i < 3; ++i) {
        const float face = (float(block[i]) + (r.direction[i] > 0.0 ? 1.0 : 0.0)) / blocks[i];
        const float at = r.direction[i] == 0.0 ? INFINITE_DISTANCE : (face - r.origin[i]) / r.direction[i];
        axis = at < end ? i : axis;
        end = min(end, at);
    }
    return end;
}

/// A ray to a light that has less than this share of its light left ends half of the time.
const float LITTLE_LEFT = 0.125;

/// isPath: collisions scatter; else they dim. carried: what the channels have, for the choice. medium: its first row.
MediumResult trackGrid(MediumBody m, uint medium, Traversal ray, vec3 carried, bool isPath, uvec4 words) {
    MediumResult result = MediumResult(vec3(1.0), vec3(0.0), false, false, 0.0);
    const GridHeader g = fetchGrid(m.grid);
    const float perLength = 1.0 / length(ray.direction);
    const GridRay r = intoGrid(g, ray, perLength);
    const float start = ray.tMin / perLength;
    const vec3 blocks = vec3(g.blocksX, g.blocksY, g.blocksZ);
    float at = r.from;
    ivec3 block = ivec3(clamp(floor((r.origin + at * r.direction) * blocks), vec3(0.0), blocks - 1.0));
    uint draw = 0u;
    bool goesOn = at < r.to;
    while (goesOn && draw < GRID_STEPS) {
        int axis;
        const float end = min(endOfBlock(r, block, blocks, axis), r.to);
        const float rate = boundOfBlock(g, block) * m.mostExtinction;
        const vec4 u = mediumNumbers(words, ++draw);
        const float next = rate > 0.0 ? at - log(1.0 - u.x) / rate : INFINITE_DISTANCE;
        if (next < end) {
            at = next;
            const MediumPoint point = mediumPoint(m, g, medium, clamp(r.origin + at * r.direction, vec3(0.0), vec3(1.0)),
                                                  ray.origin + (at * perLength) * ray.direction);
            const vec3 null_ = max(rate - point.extinction, vec3(0.0)) / rate;
            if (isPath) {
                const vec3 real = point.scattering / rate, has_ = carried * result.weight;
                if (mediaDo(MEDIA_SHINE)) result.shone += result.weight * point.emission / rate;
                const float ofReal = dot(has_, real), ofNull = dot(has_, null_), all = ofReal + ofNull;
                result.scatters = u.y * all < ofReal;
                const float probability = (result.scatters ? ofReal : ofNull) / max(all, TINY);
                result.weight *= all > 0.0 ? (result.scatters ? real : null_) / max(probability, TINY) : vec3(0.0);
                goesOn = !result.scatters && all > 0.0;
            } else {
                result.weight *= null_;
                const bool isLittle = largestComponent(result.weight) < LITTLE_LEFT;
                if (isLittle) result.weight *= u.y < 0.5 ? 2.0 : 0.0;
                goesOn = largestComponent(result.weight) > 0.0;
            }
        } else {
            at = end;
            for (int i = 0; i < 3; ++i)
                if (i == axis) block[i] += r.direction[i] > 0.0 ? 1 : -1;
            goesOn = at < r.to && all(greaterThanEqual(block, ivec3(0))) && all(lessThan(block, ivec3(blocks)));
        }
    }
    result.distance = at - start;
    result.isUnderWay = goesOn;
    return result;
}
