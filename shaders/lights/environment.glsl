// The environment: a picture around the scene, interpolated between the middles of its texels, and light samples
// in proportion to it. A texel is taken from an alias table by its weight, then a point about its middle by a tent as
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
    const uvec4 r = ROW(environmentRows, index);
    return EnvironmentTexel(uintBitsToFloat(r.x), r.y, r.z, r.w);
}

/// Relative luminance (Rec. 709), as host/core/color.hpp has it.
float luminanceOf(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

/// About the y axis, by the rotation of the environment.
vec3 turned(EnvironmentLight e, vec3 w, float direction) {
    const float s = direction * e.sinRotation;
    return vec3(e.cosRotation * w.x + s * w.z, w.y, e.cosRotation * w.z - s * w.x);
}

/// The point of the picture, in texels from its left and upper edge, that lies in direction w.
vec2 placeInEnvironment(EnvironmentLight e, vec3 w) {
    const vec3 d = turned(e, w, -1.0);
    const float u = atan(d.x, -d.z) * (0.5 * INV_PI) + 0.5;
    const float v = atan(length(d.xz), d.y) * INV_PI;
    return vec2(u * float(e.width), v * float(e.height));
}

vec3 directionInEnvironment(EnvironmentLight e, vec2 place) {
    const vec2 around = cosSin(4.0 * place.x / float(e.width)); // of the angle from +z
    const float polar = PI * place.y / float(e.height);
    const vec3 d = vec3(-sin(polar) * around.y, cos(polar), sin(polar) * around.x);
    return unit(turned(e, d, 1.0));
}

/// A row of texels beside the two nearest to a place: both interpolated, with their sine of the polar angle.
vec4 environmentRow(EnvironmentLight e, int row, uvec2 columns, float across) {
    const uint first = uint(clamp(row, 0, int(e.height) - 1)) * e.width;
    const vec3 left = radianceOf(fetchEnvironmentTexel(first + columns.x));
    const vec3 right = radianceOf(fetchEnvironmentTexel(first + columns.y));
    const float middle = clamp(float(row), 0.0, float(e.height) - 1.0) + 0.5;
    return vec4(mix(left, right, across), sin(PI * middle / float(e.height)));
}

/// place: in texels.
EnvironmentValue environmentAt(EnvironmentLight e, vec3 strength, vec2 place) {
    const vec2 from = floor(place - 0.5);
    const vec2 part = place - 0.5 - from;
    const int width = int(e.width);
    const int left = int(from.x) < 0 ? width - 1 : min(int(from.x), width - 1);
    const uvec2 columns = uvec2(left, left + 1 < width ? left + 1 : 0);
    const vec4 upper = environmentRow(e, int(from.y), columns, part.x);
    const vec4 lower = environmentRow(e, int(from.y) + 1, columns, part.x);
    const float weight =
        mix(luminanceOf(upper.rgb) * upper.w, luminanceOf(lower.rgb) * lower.w, part.y);
    const float sine = sin(PI * place.y / float(e.height));
    return EnvironmentValue(strength * mix(upper.rgb, lower.rgb, part.y),
                            weight * e.density / max(sine, TINY));
}

EnvironmentValue environmentFrom(LightRows rows, vec3 w) {
    const EnvironmentLight e = environmentLight(rows);
    return environmentAt(e, colorOf(rows), placeInEnvironment(e, w));
}

/// From u in [0, 1) a number in (-1, 1) of density 1 - |x|.
float sampleTent(float u) { return u < 0.5 ? sqrt(2.0 * u) - 1.0 : 1.0 - sqrt(2.0 - 2.0 * u); }

/// A texel by its weight; u.x is then what is left of it.
uint pickEnvironmentTexel(EnvironmentLight e, inout vec2 u) {
    ChoiceNumber c = choiceNumber(u);
    const uint count = e.width * e.height;
    uint index, fraction, within, carry, unused;
    umulExtended(c.value << 1u, count, index, fraction);
    // The number is a multiple of 2^-31: what is between two of them comes from new digits.
    umulExtended(newDigits(c), 2u * count, within, unused);
    fraction = uaddCarry(fraction, within, carry);
    index += carry;
    const float part = float(int(fraction >> 8u)) * (1.0 / 16777216.0);
    const EnvironmentTexel texel = fetchEnvironmentTexel(index);
    const bool own = part < texel.threshold;
    const float low = own ? 0.0 : texel.threshold, width = own ? texel.threshold : 1.0 - texel.threshold;
    u.x = clamp((part - low) / max(width, TINY), 0.0, 1.0 - UNIT_ROUNDOFF);
    return own ? index : texel.alias;
}

LightSample sampleEnvironment(LightRows rows, vec2 u) {
    const EnvironmentLight e = environmentLight(rows);
    const uint texel = pickEnvironmentTexel(e, u);
    vec2 place = vec2(uvec2(texel % e.width, texel / e.width)) + 0.5 + vec2(sampleTent(u.x), sampleTent(u.y));
    // Around the picture, and turned back at the poles: beyond them the interpolation repeats the last row.
    place.x += place.x < 0.0 ? float(e.width) : (place.x >= float(e.width) ? -float(e.width) : 0.0);
    place.y = abs(place.y);
    if (place.y > float(e.height)) place.y = 2.0 * float(e.height) - place.y;
    const EnvironmentValue value = environmentAt(e, colorOf(rows), place);
    LightSample s;
    s.direction = directionInEnvironment(e, place);
    s.infinite = true;
    s.target = s.direction;
    s.inversePdf = value.pdf > 0.0 ? 1.0 / value.pdf : 0.0;
    s.radiance = value.radiance * s.inversePdf;
    return s;
}
