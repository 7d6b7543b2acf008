// The environment: a picture around the scene, interpolated between the middles of its texels, and light samples
// in proportion to it. A tile is taken from an alias table, a texel of it from the tile's own by its weight, then a point
// about its middle by a tent as
// wide as the interpolation: the density of points in the picture is then the interpolated weight itself, so that
// no light is found that no sample goes to (docs/theory/estimator.md, "Environment").

struct EnvironmentValue {
    vec3 radiance;
    float pdf; ///< of samples, by solid angle
};

vec3 radianceOf(EnvironmentTexel t) {
    const uint most = (1u << ENVIRONMENT_MANTISSA_BITS) - 1u;
    const uvec3 mantissa = uvec3(t.low, t.low >> 18u | t.high << 14u, t.high >> 4u) & most;
    // 2^(exponent - ENVIRONMENT_EXPONENT_BIAS): the bits of a float.
    const float scale = uintBitsToFloat((t.high >> 22u) + 127u - ENVIRONMENT_EXPONENT_BIAS << 23u);
    return vec3(ivec3(mantissa)) * scale;
}

EnvironmentTexel fetchEnvironmentTexel(uint index) {
    const uvec4 r = ROW(environmentRows, ENVIRONMENT_COLUMN_ROWS + index);
    return EnvironmentTexel(uintBitsToFloat(r.x), r.y, r.z, r.w);
}

/// Relative luminance (Rec. 709), as host/core/color.hpp has it.
float luminanceOf(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

/// About the y axis, by the rotation of the environment.
vec3 turned(EnvironmentLight e, vec3 w, float direction) {
    const float s = direction * e.sinRotation;
    return vec3(e.cosRotation * w.x + s * w.z, w.y, e.cosRotation * w.z - s * w.x);
}

// Places in the picture are in texels from its left and upper edge. With ROWS_REACH_POLES the zenith is half a row below
// that edge, and the nadir above the lower one.

/// Rows from the zenith to the nadir.
float rowSpan(EnvironmentLight e) {
    float rows = float(int(e.height));
    if (ROWS_REACH_POLES) rows -= 1.0;
    return rows;
}

/// How many rows a place in the picture is below the zenith, and the place that is so many rows below it.
float rowsBelowZenith(float place) {
    if (ROWS_REACH_POLES) place -= 0.5;
    return place;
}
float placeBelowZenith(float rows) {
    if (ROWS_REACH_POLES) rows += 0.5;
    return rows;
}

/// The place in the picture that lies in direction w.
vec2 placeInEnvironment(EnvironmentLight e, vec3 w) {
    const vec3 d = turned(e, w, -1.0);
    const float u = atan(d.x, -d.z) * (0.5 * INV_PI) + 0.5;
    const float v = atan(length(d.xz), d.y) * INV_PI;
    return vec2(u * float(e.width), placeBelowZenith(v * rowSpan(e)));
}

vec3 directionInEnvironment(EnvironmentLight e, vec2 place) {
    const vec2 around = cosSin(4.0 * place.x / float(e.width)); // of the angle from +z
    const float polar = PI * rowsBelowZenith(place.y) / rowSpan(e);
    const vec3 d = vec3(-sin(polar) * around.y, cos(polar), sin(polar) * around.x);
    return unit(turned(e, d, 1.0));
}

/// A row of texels beside the two nearest to a place.
struct EnvironmentRow {
    vec3 radiance; ///< interpolated
    float weight;  ///< likewise: luminance, times the ratios of the texels' tiles, times the sine of the polar angle
};

EnvironmentRow environmentRow(EnvironmentLight e, uint row, uvec2 columns, float across, vec2 ratios, float perRow) {
    const vec3 left = radianceOf(fetchEnvironmentTexel(row * e.width + columns.x));
    const vec3 right = radianceOf(fetchEnvironmentTexel(row * e.width + columns.y));
    const vec3 radiance = mix(left, right, across);
    float weight = luminanceOf(radiance);
    if (GUIDES_LIGHT) weight = mix(ratios.x * luminanceOf(left), ratios.y * luminanceOf(right), across);
    // Of a row at a pole, that in the middle of the half that is there (SkyRows in scene/model/environment.hpp).
    float angle = rowsBelowZenith(float(int(row)) + 0.5) * perRow;
    if (ROWS_REACH_POLES) angle = clamp(angle, 0.25 * perRow, PI - 0.25 * perRow);
    return EnvironmentRow(radiance, weight * sin(angle));
}

/// Of the tiles of four texels, left and right in the upper row, then in the lower one.
vec4 tileRatios(EnvironmentLight e, uint table, uvec2 columns, uvec2 rows) {
    if (!GUIDES_LIGHT) return vec4(1.0);
    const uvec2 x = columns >> e.tileShift, y = rows >> e.tileShift;
    const vec4 r = uintBitsToFloat(ROW(guideRows, table + ENVIRONMENT_COLUMN_ROWS + y.x * e.tilesAcross + x.x));
    const vec2 upper = x.x == x.y ? r.xx : r.xy;
    return vec4(upper, y.x == y.y ? upper : (x.x == x.y ? r.zz : r.zw));
}

/// place: in texels; table: by which the environment's samples choose tiles.
EnvironmentValue environmentAt(EnvironmentLight e, vec3 strength, uint table, vec2 place) {
    const vec2 from = floor(place - 0.5);
    const vec2 part = place - 0.5 - from;
    const int width = int(e.width), lowest = int(e.height) - 1;
    const int left = int(from.x) < 0 ? width - 1 : min(int(from.x), width - 1);
    const uvec2 columns = uvec2(left, left + 1 < width ? left + 1 : 0);
    const uvec2 rows = uvec2(clamp(int(from.y), 0, lowest), clamp(int(from.y) + 1, 0, lowest));
    const vec4 ratios = tileRatios(e, table, columns, rows);
    const float perRow = PI / rowSpan(e); // of the polar angle
    const EnvironmentRow upper = environmentRow(e, rows.x, columns, part.x, ratios.xy, perRow);
    const EnvironmentRow lower = environmentRow(e, rows.y, columns, part.x, ratios.zw, perRow);
    const float sine = sin(rowsBelowZenith(place.y) * perRow);
    return EnvironmentValue(strength * mix(upper.radiance, lower.radiance, part.y),
                            mix(upper.weight, lower.weight, part.y) * e.density / max(sine, TINY));
}

EnvironmentValue environmentFrom(LightRows rows, uint table, vec3 w) {
    const EnvironmentLight e = environmentLight(rows);
    return environmentAt(e, colorOf(rows), table, placeInEnvironment(e, w));
}

/// From u in [0, 1) a number in (-1, 1) of density 1 - |x|.
float sampleTent(float u) { return u < 0.5 ? sqrt(2.0 * u) - 1.0 : 1.0 - sqrt(2.0 - 2.0 * u); }

/// A texel: its tile by the table, then by its weight. u.x is then what is left of it.
uvec2 pickEnvironmentTexel(EnvironmentLight e, uint table, inout vec2 u) {
    ChoiceNumber c = choiceNumber(u);
    uint fraction;
    float rest;
    const uint column = pickColumn(c, e.tiles, fraction);
    uvec4 r;
    if (GUIDES_LIGHT) r = ROW(guideRows, table + (column >> 1u));
    else r = ROW(environmentRows, column >> 1u);
    const uvec2 t = (column & 1u) == 0u ? r.xy : r.zw;
    const uint tile = choosesAlias(c, fraction, uintBitsToFloat(t.x), rest) ? t.y : column;
    c.value = uint(int(rest * 16777216.0)) << 7u | newDigits(c) >> 25u;
    const uvec2 first = quotientAndRest(tile, e.tilesAcross).yx << e.tileShift;
    const uvec2 size = min(uvec2(1u << e.tileShift), uvec2(e.width, e.height) - first);
    const uint inTile = pickColumn(c, size.x * size.y, fraction);
    const uvec2 own = first + quotientAndRest(inTile, size.x).yx;
    const EnvironmentTexel texel = fetchEnvironmentTexel(own.y * e.width + own.x);
    const bool alias = choosesAlias(c, fraction, texel.threshold, rest);
    u.x = rest;
    return alias ? quotientAndRest(texel.alias, e.width).yx : own;
}

/// s: the surface from the side where light leaves.
LightSample sampleEnvironment(const Given given, SurfacePoint s, LightRows rows, vec2 u) {
    const EnvironmentLight e = environmentLight(rows);
    const vec3 p = litPoint(s), n = shadingNormal(s);
    PortalSample aimed = NOT_AIMED;
    if (PORTALS > 0u) aimed = samplePortals(given, p, n, u);
    vec2 place = vec2(0.0);
    if (!aimed.isAimed) {
        const uvec2 texel = pickEnvironmentTexel(e, s.table, u);
        place = vec2(texel) + 0.5 + vec2(sampleTent(u.x), sampleTent(u.y));
        // Around the picture, and turned back at the poles: beyond them the interpolation repeats the last row.
        place.x += place.x < 0.0 ? float(e.width) : (place.x >= float(e.width) ? -float(e.width) : 0.0);
        float below = abs(rowsBelowZenith(place.y));
        if (below > rowSpan(e)) below = 2.0 * rowSpan(e) - below;
        place.y = placeBelowZenith(below);
    }
    vec3 direction = directionInEnvironment(e, place);
    if (aimed.isAimed) direction = aimed.direction;
    LightSample r = skySampleOnArrival(aimed, direction);
    if (!findsSkyOnArrival()) {
        if (aimed.isAimed) place = placeInEnvironment(e, direction);
        const EnvironmentValue value = environmentAt(e, colorOf(rows), s.table, place);
        r = skySample(given, p, n, aimed, direction, value.radiance, value.pdf > 0.0 ? 1.0 / value.pdf : 0.0);
    }
    return r;
}
